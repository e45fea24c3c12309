#!/bin/sh
# The largest step at which the peak of the near-fault scene's clutched pair is within 1 % of that of the Taylor series, by method
# and stiffness of the clutch, and into how many steps Runge-Kutta divides one of 5 ms: the most that come to the same digits.
# Usage: docs/stiff-clutch.sh PATH/TO/sprag
set -eu
program=$1
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
peak() { # stiffness, further settings
    stiffness=$1
    shift
    "$program" simulate scenes/near_fault.toml --out "$out" --overwrite --set output.interval_s=1 \
        --set "device.2.clutch={stiffness_ratio=$stiffness,damping_ratio=0.3}" \
        --set 'device.2.flywheel={brake_deceleration_m_s2="instant"}' "$@" > /dev/null 2>&1 || { echo nan; return; }
    awk -F'[:,]' '/"peak_rotation"/ { value = $2 } END { print value }' "$out/summary.json"
}
for stiffness in 1e3 1e4 1e5 1e6; do
    exact=$(peak "$stiffness")
    printf 'K/(m p²) = %s: peak %s' "$stiffness" "$exact"
    for method in runge-kutta-4 exponential-midpoint; do
        best=none
        for step in 1e-5 2e-5 5e-5 1e-4 2e-4 5e-4 1e-3 2e-3 5e-3; do
            found=$(peak "$stiffness" --set accuracy.method=$method --set accuracy.step_s=$step)
            awk "BEGIN { exit !(($found) / ($exact) < 1.01 && ($found) / ($exact) > 0.99) }" 2> /dev/null && best=$step || break
        done
        printf '; %s %s s' "$method" "$best"
    done
    rk() { peak "$stiffness" --set accuracy.method=runge-kutta-4 --set accuracy.step_s="$1"; }
    whole=$(rk 5e-3)
    parts=50
    until [ "$(rk "$(awk "BEGIN { printf \"%.17g\", 5e-3 / $parts }")")" = "$whole" ]; do parts=$((parts - 1)); done
    echo "; 5 ms in $parts"
done

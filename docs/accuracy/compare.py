#!/usr/bin/env python3
"""Rocking blocks as people compute them today: SciPy's integrators and a fixed-step loop, against exact peaks.

With time in 1/p, θ in rad, s = sgn θ, δ = αs − θ and k = 3σ/4 (rectangular block), between two events

    full:     (1 + κ k cos² δ) θ̈ = −[ sin δ + a cos δ ],   a = A tan α sin ωt,
    slender:  (1 + κ k) θ̈ = −[ δ + a ],                    a = A α sin ωt,

over one cycle of sine (ω in p) and quiet ground after it. κ = 1 while an inerter is engaged: never (none), always (inerter),
or while θ̇ and −[ ] have one sign (clutched-pair). At θ = 0: θ̇⁺ = η θ̇⁻. A block at rest uplifts where |a| passes tan α
(slender: α). Overturned: |θ| ≥ π/2 (slender: |θ| > α, outward, on quiet ground).

    events     solve_ivp with terminal events, started anew after each; those of the first 1e-6 do not count, so that none is
               found twice. Where SciPy gives up, the outcome is "failed".
    no-events  solve_ivp over intervals of 0.01/p; impact and clutch are looked at between them
    rk4        the classical Runge-Kutta method in plain Python; impact and clutch are looked at once a step

    python3 compare.py [--markdown]                                    the built-in cells, as CSV or as a table of medians
    python3 compare.py --cases cases.csv --reference expected.csv      what `sprag batch` reads and writes (sine pulses)

Without NumPy and SciPy it installs them into a virtual environment (--venv FOLDER; target/compare-venv by default) and continues
there. Times are the least of three, of one for runs above 0.1 s.
"""

from __future__ import annotations

import argparse
import csv
import io
import math
import statistics
import subprocess
import sys
import time
import venv
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

REQUIREMENTS = ("numpy==2.4.6", "scipy==1.17.1")
INTEGRATORS = ("RK45", "DOP853", "LSODA", "Radau")
LOOKING = (("RK45", 1e-3), ("RK45", 1e-9), ("LSODA", 1e-9))  # Without events it is the looking that errs.
INTERVAL, GAP, MOST_EVENTS = 0.01, 1e-6, 2000
REST = 1e-3  # Below this θ̇/(pα) after an impact on quiet ground nothing is left to see.

# The paper's Figures 5, 9 and 10, and full blocks; outcomes and peaks are exact.
BUILT_IN = """\
id,geometry,slenderness_deg,device,mass_ratio,restitution,pulse,frequency_ratio,amplitude_ratio,free_time,outcome,peak_rotation
figure-5-none,slender,10,none,0,0.85,sine,4,1.5,3,safe,0.40816592928974055
figure-5-inerter,slender,10,inerter,0.5,0.85,sine,4,1.5,3,safe,0.27282944174716234
figure-5-pair,slender,10,clutched-pair,0.5,0.85,sine,4,1.5,3,safe,0.23716624355911936
figure-9-none,slender,10,none,0,0.85,sine,3,5.22,3,overturned-without-impact,
figure-9-pair,slender,10,clutched-pair,0.5,0.85,sine,3,5.22,3,safe,1.788013265264602
figure-10-none,slender,10,none,0,0.85,sine,6,7.7,3,safe,1.0205210490281535
figure-10-inerter,slender,10,inerter,0.5,0.85,sine,6,7.7,3,safe,0.7238259247156099
figure-10-pair,slender,10,clutched-pair,0.5,0.85,sine,6,7.7,6,safe,0.9725191586970405
full-none,full,20,none,0,0.85,sine,5,4,6,overturned-after-impact,
full-inerter,full,20,inerter,0.5,0.85,sine,5,4,3,safe,0.6125647151343119
full-pair,full,20,clutched-pair,0.5,0.85,sine,5,4,3,safe,0.5722296108475814
full-figure-9-pair,full,5,clutched-pair,0.5,0.85,sine,3,5.22,3,safe,1.791295397234235
"""

State = tuple[float, float]  # θ, θ̇


class Cell:
    """A block under a pulse: a row of `sprag batch`, and its exact answer."""

    def __init__(self, row: dict[str, str], answer: dict[str, str]) -> None:
        self.name, self.device, self.slender = row["id"], row["device"], row["geometry"] == "slender"
        self.alpha = math.radians(float(row["slenderness_deg"]))
        self.threshold = self.alpha if self.slender else math.tan(self.alpha)
        self.amplitude = float(row["amplitude_ratio"]) * self.threshold
        self.omega, self.restitution = float(row["frequency_ratio"]), float(row["restitution"])
        self.coupling = 0.75 * float(row["mass_ratio"])
        self.pulse_end = 2.0 * math.pi / self.omega
        self.end = self.pulse_end + float(row["free_time"])
        self.outcome, self.peak = answer["outcome"], answer["peak_rotation"]

    def ground(self, t: float) -> float:
        """a."""
        return self.amplitude * math.sin(self.omega * t) if t < self.pulse_end else 0.0

    def push(self, side: float, theta: float, a: float) -> float:
        """−[ ]: θ̈ of the block alone."""
        delta = self.alpha * side - theta
        return -(delta + a) if self.slender else -(math.sin(delta) + a * math.cos(delta))

    def slope(self, side: float, engaged: bool, ground: Callable[[float], float]) -> Callable[..., State]:
        """(θ̇, θ̈) as a function of t and (θ, θ̇)."""

        def function(t: float, y: State) -> State:
            push = self.push(side, y[0], ground(t))
            if engaged:
                push /= 1.0 + self.coupling * (1.0 if self.slender else math.cos(self.alpha * side - y[0]) ** 2)
            return y[1], push

        return function

    def limit(self, quiet: bool) -> float:
        """|θ| of no return."""
        return (self.alpha + (0.0 if quiet else self.amplitude)) if self.slender else 0.5 * math.pi

    def uplift(self, t: float, end: float) -> float | None:
        """First time from t on at which |a| exceeds the threshold."""
        if (now := abs(self.ground(t)) > self.threshold) or self.amplitude <= self.threshold or t >= self.pulse_end:
            return t if now else None
        first = math.asin(self.threshold / self.amplitude) / self.omega
        return next((up for up in (first, first + math.pi / self.omega) if t <= up < end), None)


@dataclass
class Run:
    """What a run has seen so far."""

    peak: float = 0.0
    impacts: int = 0
    uplifted: bool = False
    overturned: bool = False
    failed: bool = False
    end: float = 0.0

    @property
    def outcome(self) -> str:
        """In the words of `sprag batch`."""
        fallen = "overturned-after-impact" if self.impacts else "overturned-without-impact"
        stands = "safe" if self.uplifted else "no-rocking"
        return "failed" if self.failed else fallen if self.overturned else stands


def with_events(cell: Cell, integrator: str, tolerance: float) -> Run:
    """Every event is terminal; the signs that it changes are kept beside the state."""
    from scipy.integrate import solve_ivp

    run, pair = Run(), cell.device == "clutched-pair"
    t = theta = velocity = side = direction = drive = 0.0
    for _ in range(MOST_EVENTS):
        quiet, stop = (True, cell.end) if t >= cell.pulse_end else (False, cell.pulse_end)
        if side == 0.0:
            if (up := cell.uplift(t, stop)) is None:
                run.end = cell.end
                return run
            t, run.uplifted = up, True
            side = direction = drive = -math.copysign(1.0, cell.ground(up))
        ground = (lambda _: 0.0) if quiet else (lambda time: cell.amplitude * math.sin(cell.omega * time))
        limit, soon = cell.limit(quiet), t + GAP
        outside = side * theta > limit  # A block beyond α may still be on its way back.
        events: list[Callable[[float, State], float]] = [
            lambda time, y: side * y[0] if time > soon else 1.0,
            lambda time, y: limit - side * y[0] if time > soon and not outside else 1.0,
            lambda time, y: direction * y[1] if time > soon else 1.0,
            lambda time, y: drive * cell.push(side, y[0], ground(time)) if time > soon else 1.0,
        ]
        for event in events:
            event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
        slope = cell.slope(side, cell.device == "inerter" or (pair and direction == drive), ground)
        options = {"method": integrator, "rtol": tolerance, "atol": tolerance * cell.alpha}
        try:
            found = solve_ivp(slope, (t, stop), (theta, velocity), events=events if pair else events[:3], **options)
        except ValueError:
            break
        t, theta, velocity = float(found.t[-1]), *(float(x) for x in found.y[:, -1])
        run.peak, run.end = max(run.peak, abs(theta)), t
        hit = [times.size > 0 for times in found.t_events]
        if hit[0]:
            theta, velocity, side, direction = 0.0, cell.restitution * velocity, -side, -side
            run.impacts += 1
            if abs(velocity) < cell.alpha * (REST if quiet else 1e-6) and abs(cell.ground(t)) <= cell.threshold:
                velocity = side = 0.0
                continue
        elif hit[1] or (t >= cell.pulse_end and side * theta > cell.limit(True) and (side * velocity > 0.0 or hit[2])):
            run.overturned = True
            return run
        elif hit[2]:
            velocity, direction = 0.0, -direction
        elif t >= cell.end:
            return run
        drive = -drive if pair and hit[3] else math.copysign(1.0, cell.push(side, theta, cell.ground(t)))
    run.failed = True
    return run


def looked_at(cell: Cell, step: float, advance: Callable[[Callable[..., State], float, float, State], State]) -> Run:
    """Impact, clutch, uplift and overturning are looked at once a step, as in most programs."""
    run, y, side = Run(), (0.0, 0.0), 0.0
    for index in range(math.ceil(cell.end / step)):
        t, quiet = index * step, (index + 1) * step >= cell.pulse_end
        run.end, a = t + step, cell.ground(t)
        if side == 0.0 and abs(a) <= cell.threshold:
            continue
        side, run.uplifted = side or -math.copysign(1.0, a), True
        engaged = cell.device == "inerter" or (cell.device != "none" and y[1] * cell.push(side, y[0], a) > 0.0)
        y = advance(cell.slope(side, engaged, cell.ground), t, step, y)
        run.peak = max(run.peak, abs(y[0]))
        if y[0] * side < 0.0:
            y, side, run.impacts = (y[0], cell.restitution * y[1]), -side, run.impacts + 1
            if quiet and abs(y[1]) < REST * cell.alpha:
                return run
        run.overturned = abs(y[0]) > cell.limit(quiet) and y[0] * y[1] > 0.0
        if run.overturned:
            break
    return run


def runge_kutta(f: Callable[..., State], t: float, h: float, y: State) -> State:
    """One classical step."""
    v1, a1 = f(t, y)
    v2, a2 = f(t + 0.5 * h, (y[0] + 0.5 * h * v1, y[1] + 0.5 * h * a1))
    v3, a3 = f(t + 0.5 * h, (y[0] + 0.5 * h * v2, y[1] + 0.5 * h * a2))
    v4, a4 = f(t + h, (y[0] + h * v3, y[1] + h * a3))
    return y[0] + h / 6.0 * (v1 + 2.0 * (v2 + v3) + v4), y[1] + h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4)


def without_events(cell: Cell, integrator: str, tolerance: float) -> Run:
    """solve_ivp from output point to output point."""
    from scipy.integrate import solve_ivp

    def advance(f: Callable[..., State], t: float, h: float, y: State) -> State:
        return tuple(solve_ivp(f, (t, t + h), y, method=integrator, rtol=tolerance, atol=tolerance * cell.alpha).y[:, -1].tolist())

    return looked_at(cell, INTERVAL, advance)


def timed(work: Callable[[], Run]) -> tuple[Run, float]:
    """The result and its time, s."""
    seconds: list[float] = []
    while len(seconds) < 3 and max(seconds, default=0.0) < 0.1:
        start = time.perf_counter()
        run = work()
        seconds.append(time.perf_counter() - start)
    return run, min(seconds)


def compare(cell: Cell, tolerances: list[float], steps: list[float]) -> Iterator[tuple[str, float, Run, float]]:
    """Method, setting, result and seconds."""
    for name in INTEGRATORS:
        for rtol in tolerances:
            yield f"{name} events", rtol, *timed(lambda: with_events(cell, name, rtol))
    for name, rtol in LOOKING:
        yield f"{name} no-events", rtol, *timed(lambda: without_events(cell, name, rtol))
    for step in steps:
        yield "rk4", step, *timed(lambda: looked_at(cell, step, runge_kutta))


def markdown(rows: list[list[str]]) -> Iterator[str]:
    """Medians over the cells, method by method."""
    yield "| method | setting | median error of the peak | largest | wrong outcomes | s a simulated 1/p |"
    yield "| --- | --- | --- | --- | --- | --- |"
    for key in dict.fromkeys((row[1], row[2]) for row in rows):
        group = [row for row in rows if tuple(row[1:3]) == key]
        errors = [float(row[3]) for row in group if row[3]] or [math.nan]
        speed, wrong = statistics.median(float(row[7]) for row in group), sum(row[5] == "true" for row in group)
        figures = f"{statistics.median(errors):.1e} | {max(errors):.1e} | {wrong} of {len(group)} | {speed:.1e}"
        yield f"| {key[0]} | {key[1]} | {figures} |"


def ensure_scipy(folder: Path) -> None:
    """Continues in a virtual environment where this Python has no SciPy."""
    try:
        import scipy.integrate  # noqa: F401
    except ImportError:
        if Path(sys.prefix).resolve() == folder.resolve():
            raise
        venv.create(folder, with_pip=True)
        python = next(path for path in (folder / "bin/python", folder / "Scripts/python.exe") if path.exists())
        subprocess.run([python, "-m", "pip", "install", "--quiet", *REQUIREMENTS], check=True)
        sys.exit(subprocess.run([python, *sys.argv], check=False).returncode)


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=Path, help="cases of `sprag batch`")
    parser.add_argument("--reference", type=Path, help="their results: id, outcome and peak_rotation")
    parser.add_argument("--tolerances", default="1e-3,1e-6,1e-9,1e-12", help="rtol and atol/α of events")
    parser.add_argument("--steps", default="1e-2,1e-3,1e-4,1e-5", help="of rk4, in 1/p")
    parser.add_argument("--markdown", action="store_true", help="a table of medians")
    parser.add_argument("--venv", type=Path, default=Path(__file__).resolve().parents[2] / "target" / "compare-venv")
    options = parser.parse_args()
    if (options.cases is None) != (options.reference is None):
        parser.error("--cases and --reference go together")
    ensure_scipy(options.venv)
    texts = [path.read_text() if path else BUILT_IN for path in (options.cases, options.reference)]
    cases, answers = (list(csv.DictReader(io.StringIO(text))) for text in texts)
    answer = {row["id"]: row for row in answers}
    settings = [[float(x) for x in text.split(",")] for text in (options.tolerances, options.steps)]
    writer, rows = csv.writer(io.StringIO() if options.markdown else sys.stdout), []
    writer.writerow("id,method,setting,error_peak_rotation,outcome,wrong_outcome,seconds,seconds_per_simulated_unit".split(","))
    for cell in (Cell(case, answer[case["id"]]) for case in cases if case["pulse"] == "sine"):
        for method, setting, run, seconds in compare(cell, *settings):
            wrong = run.outcome != cell.outcome
            error = "" if wrong or not cell.peak else f"{abs(run.peak / cell.alpha / float(cell.peak) - 1.0):.3e}"
            row = [cell.name, method, f"{setting:.0e}", error, run.outcome, str(wrong).lower()]
            rows.append([*row, f"{seconds:.6f}", f"{seconds / max(run.end, 1e-9):.6f}"])
            writer.writerow(rows[-1])
    sys.stdout.writelines(f"{line}\n" for line in markdown(rows) if options.markdown)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Sprag's block that slides beside Siconos (https://nonsmooth.gricad-pages.univ-grenoble-alpes.fr/siconos).

    apt install python3-siconos
    /usr/bin/python3 tests/siconos/sliding_block.py [target/release/sprag]

A planar body with two contact points by Moreau's time stepping, whose impulses Siconos finds at every step: Coulomb's law and Newton's with
restitution 0 at both corners, which for an impact at one corner is the moment of momentum about it (block.restitution = "geometric"). No
event is located, and the order is one, so that the difference from Sprag has to fall with the step.
"""

import csv
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import siconos.numerics as sn

GRAVITY = 9.80665

# α (rad), R (m), μ, θ(0)/α, ground acceleration: pulses (level in g, duration in s) and sines (amplitude in g, frequency in Hz); end, s.
CASES = {
    "slides flat": dict(alpha=0.4, size=1.0, friction=0.15, pulse=(0.4, 0.5), end=2.0),
    "slides flat, sine": dict(alpha=0.5, size=1.0, friction=0.2, sine=(0.45, 1.0), end=2.5),
    "rocks, sticks": dict(alpha=0.25, size=1.0, friction=1.0, pulse=(0.4, 0.3), end=2.0),
    "let go, slips": dict(alpha=0.5, size=1.0, friction=0.2, tilt=0.8, end=2.0),
    "let go, impacts slip": dict(alpha=0.35, size=1.0, friction=0.12, tilt=-0.7, end=2.0),
    "tips and slides": dict(alpha=0.6, size=1.0, friction=0.75, pulse=(1.6, 0.12), end=2.0),
    "tips and slides, sine": dict(alpha=0.45, size=1.0, friction=0.5, sine=(1.2, 2.5), end=1.5),
}


def corner(along, height, q):
    """Gap of the corner `along` from the middle of the base, and the matrix to its velocity, normal and tangential."""
    sin, cos = math.sin(q[2]), math.cos(q[2])
    gap = q[1] - along * sin - height * cos
    return gap, np.array([[0.0, 1.0, -along * cos + height * sin], [1.0, 0.0, -along * sin - height * cos]])


def ground(case, time):
    """ü_g, m/s²."""
    if "pulse" in case:
        level, duration = case["pulse"]
        return level * GRAVITY if time < duration else 0.0
    if "sine" in case:
        amplitude, frequency = case["sine"]
        return amplitude * GRAVITY * math.sin(2.0 * math.pi * frequency * time) if time < 1.0 / frequency else 0.0
    return 0.0


def siconos(case, step):
    """Times, θ (rad) and displacements of the base (m)."""
    alpha, size = case["alpha"], case["size"]
    half, height = size * math.sin(alpha), size * math.cos(alpha)
    tilt = case.get("tilt", 0.0) * alpha
    side = math.copysign(1.0, tilt)
    sin, cos = math.sin(tilt), math.cos(tilt)
    # The corner that carries it stands where it stood under the upright block.
    position = [side * half * (1.0 - cos) + height * sin, side * half * sin + height * cos, tilt]
    q, velocity = np.array(position), np.zeros(3)
    inverse = np.diag([1.0, 1.0, 3.0 / (size * size)])
    options = sn.SolverOptions(sn.SICONOS_FRICTION_2D_LEMKE)
    rows = [(0.0, tilt, 0.0)]
    for index in range(round(case["end"] / step)):
        force = np.array([-ground(case, (index + 0.5) * step), -GRAVITY, 0.0])
        middle = q + 0.5 * step * velocity
        free = velocity + step * force
        touching = [matrix for gap, matrix in (corner(along, height, middle) for along in (half, -half)) if gap <= 0.0]
        velocity = free
        if touching:
            matrix = np.vstack(touching)
            count = len(touching)
            problem = sn.FrictionContactProblem(2, count, matrix @ inverse @ matrix.T, matrix @ free, [case["friction"]] * count)
            impulse, relative = np.zeros(2 * count), np.zeros(2 * count)
            if sn.fc2d_driver(problem, impulse, relative, options) != 0:
                raise ArithmeticError(f"no solution at {index * step} s")
            velocity = free + inverse @ matrix.T @ impulse
        q = middle + 0.5 * step * velocity
        turn = q[2]
        which = 1.0 if turn >= 0.0 else -1.0
        base = q[0] + which * half * math.cos(turn) - height * math.sin(turn) - which * half
        rows.append(((index + 1) * step, turn, base))
    return np.array(rows)


def sprag(program, case, folder):
    """The same from history.csv."""
    lines = [
        "[block]",
        f"size_m = {case['size']}",
        f"slenderness_deg = {math.degrees(case['alpha'])!r}",
        f"friction_coefficient = {case['friction']}",
        'restitution = "geometric"',
        f"initial_rotation_ratio = {case.get('tilt', 0.0)}",
        "[[device]]",
        'kind = "none"',
        "[[ground]]",
    ]
    if "sine" in case:
        amplitude, frequency = case["sine"]
        lines += ['motion = "sine"', f"amplitude_g = {amplitude}", f"frequency_hz = {frequency}"]
        moving = 1.0 / frequency
    else:
        # Quiet ground is a pulse too weak to matter.
        level, moving = case.get("pulse", (1e-12, 0.1))
        lines += ['motion = "rectangular"', f"amplitude_g = {level}", f"duration_s = {moving}"]
    lines += ["[run]", f"free_time_s = {case['end'] - moving!r}", "[output]", "interval_s = 0.01"]
    scene = Path(folder) / "scene.toml"
    scene.write_text("\n".join(lines) + "\n")
    command = [program, "simulate", str(scene), "--out", str(Path(folder) / "out"), "--overwrite"]
    subprocess.run(command, check=True, capture_output=True)
    with open(Path(folder) / "out" / "history.csv", newline="") as table:
        rows = [(float(row["time_s"]), float(row["rotation_rad"]), float(row["displacement_m"])) for row in csv.DictReader(table)]
    run = json.loads((Path(folder) / "out" / "summary.json").read_text())["runs"][0]
    return np.array(rows), run


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else "target/release/sprag"
    steps = [1e-3, 2e-4]
    print("| case | outcome | max θ/α | max x (m) | x at the end (m) | " + " | ".join(f"apart at {step:g} s" for step in steps) + " |")
    print("| --- | --- | --- | --- | --- |" + " --- |" * len(steps))
    for name, case in CASES.items():
        with tempfile.TemporaryDirectory() as folder:
            own, run = sprag(program, case, folder)
        cells = []
        for step in steps:
            other = siconos(case, step)
            at = [np.interp(own[:, 0], other[:, 0], other[:, column]) for column in (1, 2)]
            apart = [np.max(np.abs(own[:, i + 1] - at[i])) for i in (0, 1)]
            cells.append(f"{apart[0] / case['alpha']:.1e} α, {apart[1]:.1e} m")
        peak = np.max(np.abs(own[:, 1])) / case["alpha"]
        print(
            f"| {name} | {run['outcome']} | {peak:.4f} | {np.max(np.abs(own[:, 2])):.4f} | {own[-1, 2]:.4f} | " + " | ".join(cells) + " |",
            flush=True,
        )


if __name__ == "__main__":
    main()

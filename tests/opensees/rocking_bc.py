"""Compares OpenSees' RockingBC element with Sprag: free rocking from θ = α/2, and one cycle of a sine.

In an environment with Python 3.11 and Sprag's package (docs/python.md):

    pip install openseespy==3.7.1.2
    python tests/opensees/rocking_bc.py [STEP_S]

RockingBC is a stiff elastic column on an interface that opens: what an impact takes is an outcome of its damping and of the step. So what
comes before the first impact can be compared as it is, and what comes after it with the η that OpenSees' own impact has. The interface
opens as if rotations were small, so that the force that holds the column at α/2 is 1.4 % above the rigid block's. Block and motions are
those of OpenSees' EXAMPLES/ExampleScripts/RockingBC_example.tcl, with Sprag's g.
"""

import math
import sys
from dataclasses import dataclass
from time import perf_counter

import numpy as np
import openseespy.opensees as ops
import sprag

G = 9.80665
SLENDERNESS = 0.2
WIDTH = 1.0
HEIGHT = WIDTH / math.tan(SLENDERNESS)
SIZE = 0.5 * math.hypot(WIDTH, HEIGHT)
P = math.sqrt(0.75 * G / SIZE)
DENSITY = 2.5
MASS = DENSITY * WIDTH * HEIGHT
#: So stiff that its own weight shortens the column by 2.5e-6 of its height.
STIFFNESS = DENSITY * G * HEIGHT / 5e-6
STRENGTH = -DENSITY * G * HEIGHT / 5e-3
DAMPING_RATIO = 0.05
#: The sine: ω_g/p and a_g/(gα).
FREQUENCY_RATIO, AMPLITUDE_RATIO = 6.0, 2.0
RELEASE = 0.5
DURATION = 2.5


@dataclass
class Motion:
    """|θ|/α over time, and the times of impacts."""

    time: np.ndarray
    rotation: np.ndarray
    impacts: np.ndarray

    def peaks(self) -> list[float]:
        """max |θ|/α up to the first impact, and between that and the second one."""
        first, second = self.impacts[:2]
        return [float(self.rotation[(self.time > start) & (self.time <= end)].max()) for start, end in [(-1.0, first), (first, second)]]


def restitution(peak: float, before: float) -> float:
    """η of an impact of the full block between turns at these θ/α, by energy: θ̇² = 2p²(cos α − cos(α − |θ|))."""
    fall = [math.cos(SLENDERNESS * (1 - ratio)) - math.cos(SLENDERNESS) for ratio in (peak, before)]
    return math.sqrt(fall[0] / fall[1])


def model() -> None:
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    for node, y in enumerate([0.0, 0.5 * HEIGHT, HEIGHT], start=1):
        ops.node(node, 0.0, y)
    ops.fix(1, 1, 1, 1)
    settings = {"-convlim": 1e-15, "-useshear": 0, "-useUelNM": 1, "-usecomstiff": 0, "-NlimN": 0.001, "-NlimT": 1.0}
    options = [item for pair in settings.items() for item in pair]
    ops.element("RockingBC", 1, 2, 1, 15, STIFFNESS, 0.0, STRENGTH, WIDTH, 1.0, 0.0, *options)
    ops.geomTransf("Corotational", 1)
    ops.element("elasticBeamColumn", 2, 2, 3, WIDTH, STIFFNESS, WIDTH**3 / 12, 1)
    ops.mass(2, MASS, MASS, MASS * (WIDTH**2 + HEIGHT**2) / 12)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(2, 0.0, -MASS * G, 0.0)
    ops.constraints("Transformation")
    ops.numberer("RCM")
    ops.system("UmfPack")
    ops.test("EnergyIncr", 1e-10, 100)
    ops.algorithm("Newton")
    ops.integrator("LoadControl", 0.1)
    ops.analysis("Static")
    run(10)
    ops.loadConst("-time", 0.0)


def run(steps: int, *step: float) -> None:
    if ops.analyze(steps, *step) != 0:
        raise SystemExit(f"OpenSees does not converge at t = {ops.getTime()} s")


def opensees(step: float, released: bool) -> Motion:
    model()
    stiffness = 2 * DAMPING_RATIO / math.sqrt(ops.eigen(1)[0])
    if released:
        ops.timeSeries("Linear", 2)
        ops.pattern("Plain", 2, 2)
        ops.load(2, 1.0, 0.0, 0.0)
        ops.integrator("DisplacementControl", 2, 3, -RELEASE * SLENDERNESS / 200)
        run(200)
        held = ops.getLoadFactor(2) / (MASS * G)
        print(f"force that holds the column, over its weight: {held:.5f}; rigid: {math.tan((1 - RELEASE) * SLENDERNESS):.5f}")
        ops.remove("loadPattern", 2)
    else:
        frequency, amplitude = FREQUENCY_RATIO * P, AMPLITUDE_RATIO * SLENDERNESS * G
        ops.timeSeries("Trig", 3, 0.0, 2 * math.pi / frequency, 2 * math.pi / frequency, "-factor", amplitude)
        ops.pattern("UniformExcitation", 3, 1, "-accel", 3)
    ops.setTime(0.0)
    ops.rayleigh(0.0, stiffness, 0.0, 0.0)
    ops.wipeAnalysis()
    ops.constraints("Transformation")
    ops.numberer("RCM")
    ops.system("UmfPack")
    ops.test("NormUnbalance", 1e-7, 100)
    ops.algorithm("Newton")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    times, rotations = [0.0], [ops.nodeDisp(2, 3)]
    while times[-1] < DURATION:
        run(1, step)
        times.append(ops.getTime())
        rotations.append(ops.nodeDisp(2, 3))
    time, rotation = np.array(times), np.array(rotations) / SLENDERNESS
    # Before it uplifts, the elastic column hardly leaves the vertical.
    uplifted = time > time[np.argmax(np.abs(rotation) > 1e-3)]
    changes = np.flatnonzero((rotation[:-1] * rotation[1:] < 0) & uplifted[:-1])
    left, right = rotation[changes], rotation[changes + 1]
    return Motion(time, np.abs(rotation), time[changes] + step * left / (left - right))


def of_sprag(restitution: float, released: bool) -> Motion:
    block = sprag.Block(
        size_m=SIZE,
        slenderness_deg=math.degrees(SLENDERNESS),
        restitution=restitution,
        initial_rotation_ratio=RELEASE if released else 0.0,
    )
    sine = sprag.Sine(amplitude_m_s2=AMPLITUDE_RATIO * SLENDERNESS * G, frequency_ratio=FREQUENCY_RATIO)
    scene = sprag.Scene(block=block, ground=[] if released else [sine], output=sprag.Output(interval_s=1e-4))
    (found,) = sprag.simulate(scene)
    return Motion(found.t, np.abs(found.rotation_rad) / SLENDERNESS, np.array(found.impacts_s))


def main() -> None:
    step = float(sys.argv[1]) if len(sys.argv) > 1 else 2e-4
    etas = {"Housner's": 1 - 1.5 * math.sin(SLENDERNESS) ** 2}
    for name, released in [("free rocking", True), ("sine", False)]:
        start = perf_counter()
        motions = {"OpenSees": opensees(step, released)}
        print(f"{name}: {DURATION} s in steps of {step} s, {perf_counter() - start:.0f} s")
        if released:
            etas["OpenSees' own"] = restitution(motions["OpenSees"].peaks()[1], RELEASE)
        motions |= {f"Sprag, {whose} η {eta:.4f}": of_sprag(eta, released) for whose, eta in etas.items()}
        for label, motion in motions.items():
            (first, second), (before, after) = motion.impacts[:2], motion.peaks()
            print(f"  {label:30} impacts at {first:.4f} s and {second:.4f} s, peaks {before:.4f} α and {after:.4f} α")


main()

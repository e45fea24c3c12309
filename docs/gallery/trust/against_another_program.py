r"""
Against another program
=======================

`Numerics-in-Motion/blocks <https://github.com/Numerics-in-Motion/blocks>`_, folder ``under-this-pulse``, brackets the least amplitude of
one sine of 0.5 s that overturns Housner's block (α = 0.2, :math:`\eta = 1 - 1.5\sin^2\alpha`, g = 9.80665 m/s²) for five sizes, by DOP853
with two audits of its events. Sprag's amplitudes, by bisection, lie in all four brackets; the block of 4 m stands up to the end of the
search in both.

It counts a block as overturned when it reaches α; Sprag when it cannot come back, or, in a map, when it reaches α if it is asked to. That
makes no difference to the *first* amplitude, but further up the pulse brings some blocks back that have passed α: the last lines below have
one by both definitions.
"""

import math

import matplotlib.pyplot as plt
import numpy as np
import sprag

SLENDERNESS = 0.2
#: Half diagonal in m, and the ends of its bracket of a_g/(g tan α).
BRACKETS = {
    0.25: (1.2618848, 1.2618945),
    0.5: (1.4584375, 1.4584473),
    1.0: (2.1637793, 2.1637891),
    2.0: (5.1549219, 5.1549316),
}


def response(size: float, amplitude: float) -> sprag.Run:
    """The response of a block of this size."""
    block = sprag.Block(size_m=size, slenderness_deg=math.degrees(SLENDERNESS), restitution="geometric")
    ground = sprag.Sine(amplitude_ratio=amplitude, frequency_hz=2.0)
    (run,) = sprag.simulate(sprag.Scene(block=block, device=sprag.NoDevice(), ground=ground))
    return run


def least_amplitude(size: float, low: float, high: float) -> float:
    """The amplitude between `low`, which does not overturn the block, and `high`, which does."""
    while high - low > 1e-9:
        middle = (low + high) / 2
        low, high = (low, middle) if response(size, middle).outcome.overturned else (middle, high)
    return (low + high) / 2


figure, axis = plt.subplots(figsize=(8, 4), layout="constrained")
for row, (size, (low, high)) in enumerate(BRACKETS.items()):
    # From its bracket, made ten times as wide, so that an amplitude beside it would be found.
    width = high - low
    ours = least_amplitude(size, low - 10 * width, high + 10 * width)
    print(f"R = {size} m: {low:.7f} < {ours:.8f} < {high:.7f}")
    assert low < ours < high
    axis.plot([-1, 1], [row, row], "|-", color="C0", markersize=14, label="its bracket" if row == 0 else None)
    axis.plot(2 * (ours - low) / width - 1, row, "o", color="C1", label="Sprag" if row == 0 else None)
assert not any(response(4.0, amplitude).outcome.overturned for amplitude in np.linspace(1.0, 6.0, 501))
back = response(0.25, 2.71)
print(f"R = 0.25 m at 2.71: {back.message}, peak {back.peak_rotation:.2f} α")
assert not back.outcome.overturned
assert back.peak_rotation > 1
axis_of_map = sprag.Axis(key="ground.0.amplitude_ratio", start=2.70, stop=2.72, cells=3)
for definition in ["no-return", "slenderness"]:
    found = sprag.map(back.scene, x=axis_of_map, overturned_at=definition).outcome
    print(f"R = 0.25 m at 2.70, 2.71 and 2.72, {definition}: {[sprag.Outcome(code).name for code in found.ravel()]}")
axis.set_yticks(range(len(BRACKETS)), labels=[f"R = {size:g} m" for size in BRACKETS])
axis.set(xlabel="distance from the middle of its bracket, in half widths of 4.9e-6", xlim=(-2, 2), ylim=(-0.6, 3.6))
axis.legend(loc="upper right")
plt.show()

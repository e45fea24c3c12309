r"""
A clutch law of one's own
=========================

A law is a function of the :py:class:`sprag.Situation` at a control tick. This one is Eq. 10 but for a band around upright, in which the
pair is left alone: fewer switches, for clutches that wear. It runs in closed loop with the sensors of a real board, whose estimates it
sees.
"""

import matplotlib.pyplot as plt
import numpy as np
import sprag

scene = sprag.Scene(
    block=sprag.Block(size_m=2.0, slenderness_deg=10.0, restitution=0.85),
    device=sprag.ClutchedPair(mass_ratio=0.5, engagement="rigid"),
    ground=sprag.Ricker(amplitude_g=0.45, frequency_hz=1.0),
    controller=sprag.Controller(sensors=sprag.Sensors(suite="adis16470", seed=1)),
)


def eq_10(at: sprag.Situation) -> bool:
    """Resists while the acceleration, as far as the ground and the weight push, has the sign of the velocity."""
    return at.push_sign == at.velocity_sign


def not_near_upright(at: sprag.Situation) -> bool:
    """The same, but for rotations below a tenth of α."""
    return eq_10(at) and abs(at.rotation_rad) > 0.1 * at.slenderness_rad


figure, (motion, clutch) = plt.subplots(2, 1, figsize=(9, 5), sharex=True, height_ratios=[2, 1], layout="constrained")
for row, law in enumerate([eq_10, not_near_upright]):
    loop = sprag.closed_loop(scene, law=law)
    switches = np.count_nonzero(np.diff(loop.columns["engaged"]))
    motion.plot(loop.t, loop.columns["rotation_rad"] / scene.slenderness_rad, label=f"{law.__name__}: peak {loop.peak_rotation:.3f}")
    clutch.fill_between(loop.t, row, row + 0.8 * (loop.columns["engaged"] > 0), step="post", label=f"{switches} switches")
motion.set_ylabel(r"$\theta/\alpha$")
clutch.set(xlabel="t (s)", yticks=[], ylabel="engaged", xlim=(1, 6))
motion.legend(loc="upper right")
clutch.legend(loc="upper left")
plt.show()

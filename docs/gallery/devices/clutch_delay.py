r"""
Clutches that come late
=======================

A clutch takes time to close and to open. The peak rotation of a bridge pier under a wavelet, over that time, with flywheels that keep
their speed while they are released. On the left is the clutch of Eq. 10. A curve jumps where an engagement comes so late that it is lost:
the release is due already.
"""

import matplotlib.pyplot as plt
import sprag

scene = sprag.Scene(
    block=sprag.Block(size_m=2.0, slenderness_deg=10.0, restitution=0.85),
    device=[
        sprag.NoDevice(),
        sprag.Inerter(mass_ratio=0.5),
        sprag.ClutchedPair(mass_ratio=0.5, engagement="rigid", actuation=sprag.Actuation(engagement_delay_s=0.0)),
    ],
    ground=sprag.Ricker(amplitude_g=0.5, frequency_hz=1.0),
)
none, inerter, _ = sprag.simulate(scene)

figure, axis = plt.subplots(figsize=(8, 4.5), layout="constrained")
for key in ("engagement_delay_s", "release_delay_s"):
    cut = sprag.map(scene, x=sprag.Axis(key=f"device.2.actuation.{key}", start=0.0, stop=0.3, cells=601))
    axis.plot(1000 * cut.x, cut.peak_rotation[2, 0], label=f"pair, {key.split('_')[0]} late")
axis.axhline(none.peak_rotation, color="k", linestyle=":", label="no device")
axis.axhline(inerter.peak_rotation, color="k", linestyle="--", label="one inerter")
axis.set(xlabel="delay (ms)", ylabel=r"max $|\theta|/\alpha$", ylim=(0.4, 1.0))
axis.legend()
plt.show()

r"""
How much the restitution matters
================================

The ratio of the angular velocities after and before an impact is the parameter of a rocking block that is known least. Housner's value,
the dashed line, is of a block that hits the ground with its edge alone: :math:`1 - 2\sin^2\alpha/\lambda`. Which blocks overturn under a
sine, over restitution and amplitude?
"""

import matplotlib.pyplot as plt
import numpy as np
import sprag

SLENDERNESS = np.radians(15.0)

scene = sprag.Scene(
    block=sprag.Block(size_m=2.0, slenderness_deg=15.0),
    device=[sprag.NoDevice(), sprag.Inerter(mass_ratio=0.5), sprag.ClutchedPair(mass_ratio=0.5)],
    ground=sprag.Sine(amplitude_g=0.5, frequency_hz=1.2),
)
outcomes = sprag.map(
    scene,
    x=sprag.Axis(key="block.restitution", start=0.5, stop=1.0, cells=126),
    y=sprag.Axis(key="ground.0.amplitude_g", start=0.25, stop=1.5, cells=126),
)

figure, axes = plt.subplots(1, 3, figsize=(10, 4), sharey=True, layout="constrained")
for device, axis in enumerate(axes):
    outcomes.plot(axis, device=device)
    axis.axvline(1 - 1.5 * np.sin(SLENDERNESS) ** 2, color="k", linestyle="--", linewidth=1)
    axis.set(title=outcomes.devices[device], xlabel="restitution $\\eta$", ylabel="")
axes[0].set_ylabel("amplitude (g)")
figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
plt.show()

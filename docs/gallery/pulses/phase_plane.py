r"""
Phase plane
===========

Free rocking from 0.9 α, and the same blocks under a pulse. An impact is a jump towards rest at θ = 0. The dashed lines lead to the tip,
where the bare block stands on its toe without falling (θ = ±α): left to itself outside them, it overturns.
"""

import matplotlib.pyplot as plt
import numpy as np
import sprag

devices = [sprag.NoDevice(), sprag.Inerter(mass_ratio=0.5), sprag.ClutchedPair(mass_ratio=0.5)]
shape = {"frequency_parameter_1_s": 1.0, "slenderness_deg": 10.0, "geometry": "slender", "restitution": 0.85}
scenes = {
    "free rocking": sprag.Scene(block=sprag.Block(initial_rotation_ratio=0.9, **shape), device=devices),
    "under a sine pulse": sprag.Scene(
        block=sprag.Block(**shape), device=devices, ground=sprag.Sine(amplitude_ratio=3.0, frequency_ratio=4.0)
    ),
}

figure, axes = plt.subplots(1, 2, figsize=(10, 4.5), layout="constrained")
for axis, (title, scene) in zip(axes, scenes.items(), strict=True):
    for run in sprag.simulate(scene):
        axis.plot(run.rotation_rad / scene.slenderness_rad, run.velocity_rad_s / scene.slenderness_rad, label=run.device, linewidth=1)
    rotation = np.linspace(0.0, 1.0, 2)
    for side in (1, -1):
        # The energy of the slender block at its tip: (θ̇/(pα))² = (1 − |θ|/α)².
        axis.plot(side * rotation, side * (1 - rotation), "k--", linewidth=0.8)
    axis.set(title=title, xlabel=r"$\theta/\alpha$", ylabel=r"$\dot\theta/(p\,\alpha)$")
axes[0].legend()
plt.show()

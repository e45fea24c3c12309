r"""
Histories under a pulse
=======================

Rotations of Figures 5 and 10 of Thiers-Moggia and Málaga-Chuquitaype (2019), and below them the forces of the two flywheels of the pair,
which take turns. In Figure 5 the devices make the motion smaller and shorter; in Figure 10 the pair comes within 3 % of overturning under
a pulse that one inerter bears easily.
"""

import matplotlib.pyplot as plt
import numpy as np
import sprag

block = sprag.Block(frequency_parameter_1_s=1.0, slenderness_deg=10.0, geometry="slender", restitution=0.85)
devices = [sprag.NoDevice(), sprag.Inerter(mass_ratio=0.5), sprag.ClutchedPair(mass_ratio=0.5)]
pulses = {
    "Figure 5": sprag.Sine(amplitude_ratio=1.5, frequency_ratio=4.0),
    "Figure 10": sprag.Sine(amplitude_ratio=7.7, frequency_ratio=6.0),
}

figure, axes = plt.subplots(2, 2, figsize=(10, 5.5), sharex="col", sharey="row", height_ratios=[2, 1], layout="constrained")
for column, (title, pulse) in enumerate(pulses.items()):
    scene = sprag.Scene(block=block, device=devices, ground=pulse, duration=sprag.Duration(free_time_ratio=8.0))
    runs = sprag.simulate(scene)
    for run in runs:
        axes[0, column].plot(run.t, run.rotation_rad / scene.slenderness_rad, label=f"{run.device}, peak {run.peak_rotation:.3f}")
    for number, force in enumerate(runs[-1].force_ratio, start=1):
        axes[1, column].plot(runs[-1].t, np.where(runs[-1].engaged == number, force, np.nan), label=f"flywheel {number}")
    axes[0, column].set_title(title)
    axes[0, column].legend()
    # The frequency parameter is 1/s here, so seconds are p t.
    axes[1, column].set(xlabel=r"$p\,t$", xlim=(0, 8))
axes[0, 0].set_ylabel(r"$\theta/\alpha$")
axes[1, 0].set_ylabel(r"$F/(mg)$")
axes[1, 0].legend()
plt.show()

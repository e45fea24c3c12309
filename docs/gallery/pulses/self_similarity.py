r"""
Self-similarity
===============

Two blocks of different size and slenderness under pulses of equal dimensionless groups: the frequency over p and the amplitude over the
uplift threshold. Slender blocks follow one curve, with the inerter and with the pair; exact ones nearly do (Figures 6 and 7 of
Thiers-Moggia and Málaga-Chuquitaype 2019).
"""

import matplotlib.pyplot as plt
import sprag

devices = [sprag.NoDevice(), sprag.Inerter(mass_ratio=0.5), sprag.ClutchedPair(mass_ratio=0.5)]
blocks = {"R = 2 m, α = 10°": (2.0, 10.0, "-"), "R = 5 m, α = 20°": (5.0, 20.0, "--")}

figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), sharey=True, layout="constrained")
for axis, geometry in zip(axes, ("slender", "full"), strict=True):
    for name, (size, slenderness, style) in blocks.items():
        scene = sprag.Scene(
            block=sprag.Block(size_m=size, slenderness_deg=slenderness, geometry=geometry, restitution=0.85),
            device=devices,
            ground=sprag.Sine(amplitude_ratio=2.0, frequency_ratio=5.0),
            duration=sprag.Duration(free_time_ratio=7.0),
        )
        p = scene.frequency_parameter_1_s
        for colour, run in enumerate(sprag.simulate(scene)):
            label = f"{run.device}, {name}"
            axis.plot(p * run.t, run.rotation_rad / scene.slenderness_rad, f"C{colour}{style}", linewidth=1.5, label=label)
    axis.set(title=f"{geometry} equation", xlabel=r"$p\,t$", xlim=(0, 8))
axes[0].set_ylabel(r"$\theta/\alpha$")
figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
plt.show()

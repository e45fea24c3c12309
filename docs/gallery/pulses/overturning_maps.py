r"""
Overturning maps
================

Which blocks overturn under one cycle of a sine, by the frequency and the amplitude of the pulse: alone, with an inerter, and with a
clutched pair. The window and the blocks are those of Figure 8b of Thiers-Moggia and Málaga-Chuquitaype (2019).
"""

import matplotlib.pyplot as plt
import sprag

scene = sprag.Scene(
    block=sprag.Block(frequency_parameter_1_s=1.0, slenderness_deg=20.0, restitution=0.85),
    device=[sprag.NoDevice(), sprag.Inerter(mass_ratio=0.5), sprag.ClutchedPair(mass_ratio=0.5)],
    ground=sprag.Sine(amplitude_ratio=1.0, frequency_ratio=1.0),
)
outcomes = sprag.map(
    scene,
    x=sprag.Axis(key="ground.0.frequency_ratio", start=0.2, stop=8.0, cells=313),
    y=sprag.Axis(key="ground.0.amplitude_ratio", start=1.0, stop=10.0, cells=181),
)

figure, axes = plt.subplots(1, 3, figsize=(10, 4), sharey=True, layout="constrained")
for device, axis in enumerate(axes):
    outcomes.plot(axis, device=device)
    share = (outcomes.outcome[device] >= sprag.Outcome.OVERTURNED_WITHOUT_IMPACT).mean()
    axis.set(title=f"{outcomes.devices[device]}: {share:.1%} overturn", xlabel=r"$\omega_g/p$", ylabel="")
axes[0].set_ylabel(r"$a_g/(g\,\tan\alpha)$")
figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
plt.show()

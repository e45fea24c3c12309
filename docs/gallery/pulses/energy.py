r"""
Where the energy goes
=====================

The energy ledger of Figure 5, over the barrier that a block must pass to overturn: what is stored, what impacts have taken, and what has
gone with the flywheel that the clutch releases. With the pair the flywheels take more than the impacts.
"""

import matplotlib.pyplot as plt
import sprag

scene = sprag.Scene(
    block=sprag.Block(frequency_parameter_1_s=1.0, slenderness_deg=10.0, geometry="slender", restitution=0.85),
    device=[sprag.NoDevice(), sprag.Inerter(mass_ratio=0.5), sprag.ClutchedPair(mass_ratio=0.5)],
    ground=sprag.Sine(amplitude_ratio=1.5, frequency_ratio=4.0),
    output=sprag.Output(energy=True),
)

figure, axes = plt.subplots(1, 3, figsize=(10, 3.8), sharey=True, layout="constrained")
for run, axis in zip(sprag.simulate(scene), axes, strict=True):
    energy = run.energy
    stored = energy["kinetic"] + energy["potential"] + energy["stored"]
    axis.stackplot(
        energy["time_s"],
        stored,
        energy["impact"],
        energy["clutch"] + energy["brake"],
        labels=["in block and flywheels", "lost in impacts", "lost with flywheels"],
    )
    axis.plot(energy["time_s"], energy["input"], "k", linewidth=1, label="input")
    axis.set(title=run.device, xlabel=r"$p\,t$", xlim=(0, 12))
axes[0].set_ylabel("energy over the barrier")
figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
plt.show()

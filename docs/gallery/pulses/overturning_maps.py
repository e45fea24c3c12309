r"""
Overturning maps
================

Which blocks overturn under one cycle of a sine, by the frequency and the amplitude of the pulse: alone, with an inerter, and with a
clutched pair. The window and the blocks are those of Figure 8b of Thiers-Moggia and Málaga-Chuquitaype (2019).
"""

import matplotlib.pyplot as plt
import sprag
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

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

colours = {"no rocking": "white", "safe": "#d9e6f2", "overturned without impact": "#3b3b5c", "overturned after impact": "#d9822b"}
figure, axes = plt.subplots(1, 3, figsize=(10, 4), sharey=True, layout="constrained")
for device, axis in enumerate(axes):
    axis.pcolormesh(outcomes.x, outcomes.y, outcomes.outcome[device], cmap=ListedColormap(list(colours.values())), vmin=0, vmax=3)
    share = (outcomes.outcome[device] >= sprag.Outcome.OVERTURNED_WITHOUT_IMPACT).mean()
    axis.set_title(f"{outcomes.devices[device]}: {share:.1%} overturn")
    axis.set_xlabel(r"$\omega_g/p$")
axes[0].set_ylabel(r"$a_g/(g\,\tan\alpha)$")
figure.legend(
    handles=[Patch(facecolor=colour, label=name) for name, colour in list(colours.items())[1:]], loc="outside lower center", ncols=3
)
plt.show()

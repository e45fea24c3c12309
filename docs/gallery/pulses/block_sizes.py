r"""
Which sizes overturn
====================

The scale effect, for designers: the amplitude of a one-second wavelet that overturns a block, over its size, for three slendernesses.
Larger blocks stand more. The dotted lines are the uplift thresholds, :math:`g\,\tan\alpha`, which do not depend on the size.
"""

import matplotlib.pyplot as plt
import numpy as np
import sprag

amplitude = sprag.Axis(key="ground.0.amplitude_g", start=0.05, stop=2.5, cells=124)
size = sprag.Axis(key="block.size_m", start=0.3, stop=8.0, cells=48, logarithmic=True)

figure, axis = plt.subplots(figsize=(8, 5), layout="constrained")
for colour, slenderness in enumerate([10.0, 15.0, 20.0]):
    scene = sprag.Scene(
        block=sprag.Block(size_m=1.0, slenderness_deg=slenderness, restitution="geometric"),
        device=[sprag.NoDevice(), sprag.ClutchedPair(mass_ratio=0.5)],
        ground=sprag.Ricker(amplitude_g=0.5, frequency_hz=1.0),
    )
    outcomes = sprag.map(scene, x=size, y=amplitude)
    for device, style in enumerate(["-", "--"]):
        overturned = outcomes.outcome[device] >= sprag.Outcome.OVERTURNED_WITHOUT_IMPACT
        least = np.where(overturned.any(axis=0), outcomes.y[overturned.argmax(axis=0)], np.nan)
        axis.plot(outcomes.x, least, f"C{colour}{style}", label=f"α = {slenderness:g}°, {outcomes.devices[device]}")
    axis.axhline(scene.uplift_threshold_g, color=f"C{colour}", linestyle=":", linewidth=1)
axis.set(xscale="log", xlabel="R (m)", ylabel="least amplitude that overturns (g)", ylim=(0, 2.5))
axis.set_xticks([0.3, 0.5, 1, 2, 4, 8], labels=["0.3", "0.5", "1", "2", "4", "8"], minor=False)
axis.minorticks_off()
axis.legend()
plt.show()

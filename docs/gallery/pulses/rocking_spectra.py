r"""
Rocking spectra
===============

The largest rotation and acceleration of blocks that stand, over the frequency of the pulse, at two amplitudes. A line ends where the
block overturns. These are cuts as in Figure 13 of Thiers-Moggia and Málaga-Chuquitaype (2019): with the pair rotations are smaller under
weak pulses, and accelerations larger than with one inerter under strong ones.
"""

import matplotlib.pyplot as plt
import sprag

scene = sprag.Scene(
    block=sprag.Block(frequency_parameter_1_s=1.0, slenderness_deg=20.0, restitution=0.85),
    device=[sprag.NoDevice(), sprag.Inerter(mass_ratio=0.5), sprag.ClutchedPair(mass_ratio=0.5)],
    ground=sprag.Sine(amplitude_ratio=1.0, frequency_ratio=1.0),
)
frequencies = sprag.Axis(key="ground.0.frequency_ratio", start=0.2, stop=8.0, cells=400)

figure, axes = plt.subplots(2, 2, figsize=(9, 6), sharex=True, layout="constrained")
for column, amplitude in enumerate([2.0, 8.0]):
    cut = sprag.map(scene.set("ground.0.amplitude_ratio", amplitude), x=frequencies)
    for device, name in enumerate(cut.devices):
        axes[0, column].plot(cut.x, cut.peak_rotation[device, 0], label=name)
        axes[1, column].plot(cut.x, cut.peak_acceleration[device, 0])
    axes[0, column].set_title(rf"$a_g = {amplitude:g}\,g\,\tan\alpha$")
    axes[1, column].set_xlabel(r"$\omega_g/p$")
axes[0, 0].set_ylabel(r"peak rotation over $\alpha$")
axes[1, 0].set_ylabel(r"peak acceleration over $p^2\alpha$")
axes[0, 0].legend()
plt.show()

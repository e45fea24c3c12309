r"""
Incremental dynamic analysis
============================

Each motion is scaled up until it overturns the block, and the peak rotation is drawn over the scaled peak acceleration (Vamvatsikos and
Cornell 2002). A curve may weave: a stronger motion may rock a block less, and a block that has overturned may stand again further up. The
bold line is the median over the motions, overturned counted as infinite, as far as it exists.
"""

import matplotlib.pyplot as plt
import numpy as np
import sprag

STEP = 0.01
random = np.random.default_rng(5)
records = []
for number in range(20):
    t = np.arange(0.0, 15.0, STEP)
    frequency = np.fft.rfftfreq(len(t), STEP)
    # A hill of frequencies around 1 Hz, and a rise and fall in time.
    noise = np.fft.irfft(np.fft.rfft(random.normal(size=len(t))) * frequency * np.exp(-((frequency / 1.2) ** 2)), len(t))
    acceleration = noise * (t / 4) ** 2 * np.exp(2 * (1 - t / 4))
    records.append(sprag.Record(acceleration / np.abs(acceleration).max(), time_step_s=STEP, units="g", name=f"motion {number}"))

block = sprag.Block(size_m=1.5, slenderness_deg=10.0, restitution=0.85)
devices = [sprag.NoDevice(), sprag.ClutchedPair(mass_ratio=0.5)]
pga = sprag.Axis(key="ground.0.scale", start=0.02, stop=0.6, cells=117)

curves = [sprag.map(sprag.Scene(block=block, device=devices, ground=record), x=pga) for record in records]
figure, axes = plt.subplots(1, 2, figsize=(9, 5), sharey=True, layout="constrained")
for device, axis in enumerate(axes):
    peaks = np.array([curve.peak_rotation[device, 0] for curve in curves])
    axis.plot(peaks.T, curves[0].x, color="0.7", linewidth=0.8)
    median = np.median(np.where(np.isnan(peaks), np.inf, peaks), axis=0)
    axis.plot(np.where(np.isinf(median), np.nan, median), curves[0].x, color="C3", linewidth=2.5, label="median")
    axis.set(title=curves[0].devices[device], xlabel=r"max $|\theta|/\alpha$", xlim=(0, 1.5))
axes[0].set_ylabel("PGA (g)")
axes[0].legend()
plt.show()

r"""
Error against time
==================

What methods cost and err: the peak rotation of Figure 5 with the pair, over the processor time of a simulated second. Steps that locate
no event err by the step, whatever the method; the Taylor method, which is the default, reaches rounding for hardly more time than 1e-4
takes. The closed form is of slender blocks under such pulses only. Times are of the machine that built this page.
"""

import matplotlib.pyplot as plt
import sprag

scene = sprag.Scene(
    block=sprag.Block(frequency_parameter_1_s=1.0, slenderness_deg=10.0, geometry="slender", restitution=0.85),
    device=sprag.ClutchedPair(mass_ratio=0.5),
    ground=sprag.Sine(amplitude_ratio=1.5, frequency_ratio=4.0),
    duration=sprag.Duration(free_time_ratio=8.0),
)
rows = sprag.accuracy(scene, cells=0, smallest_step=1e-3, threads=1).to_pandas()
rows = rows[(rows.precision == "f64") & (rows.math == "libm") & (rows.peak_rotation_error > 0)]

figure, axis = plt.subplots(figsize=(8, 5), layout="constrained")
for (method, events), of_method in rows.groupby(["method", "events"], sort=False):
    axis.loglog(of_method.nanoseconds_per_s / 1000, of_method.peak_rotation_error, "o-", markersize=4, label=f"{method}, {events}")
axis.set(xlabel="processor time per simulated second (µs)", ylabel="error of the peak rotation over the peak")
axis.legend()
plt.show()

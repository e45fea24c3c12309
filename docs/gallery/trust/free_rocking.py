r"""
Free rocking beside Housner
===========================

A slender block that is let go at :math:`\theta_0` loses its amplitude impact by impact. Housner (1963) gave the peak after n impacts,
:math:`\phi_n = 1 - \sqrt{1 - \eta^{2n}\,(1 - (1 - \phi_0)^2)}` with :math:`\phi = \theta/\alpha`, and the time between them,
:math:`(2/p)\,\cosh^{-1}(1/(1 - \phi_n))`. Circles are his, lines are Sprag's; the largest difference of the times is printed.
"""

import matplotlib.pyplot as plt
import numpy as np
import sprag

RESTITUTION = 0.9

figure, axis = plt.subplots(figsize=(9, 4.2), layout="constrained")
for start in (0.3, 0.6, 0.9):
    block = sprag.Block(
        frequency_parameter_1_s=1.0,
        slenderness_deg=10.0,
        geometry="slender",
        restitution=RESTITUTION,
        initial_rotation_ratio=start,
    )
    scene = sprag.Scene(block=block, device=sprag.NoDevice())
    (run,) = sprag.simulate(scene)

    impacts = np.arange(12)
    peak = 1 - np.sqrt(1 - RESTITUTION ** (2 * impacts) * (1 - (1 - start) ** 2))
    half = np.arccosh(1 / (1 - peak))
    # A quarter of a cycle to the first impact, and half a cycle from one to the next.
    peak_times = np.concatenate([[0.0], half[0] + 2 * np.cumsum(half[1:]) - half[1:]])
    difference = np.abs(peak_times + half - run.impacts_s[: len(impacts)]).max()
    print(f"from {start} α: impacts differ by {difference:.1e} / p at most")

    (line,) = axis.plot(run.t, run.rotation_rad / scene.slenderness_rad, label=rf"$\theta_0 = {start}\,\alpha$")
    axis.plot(peak_times, peak * (-1) ** impacts, "o", color=line.get_color(), fillstyle="none")
    assert difference < 1e-9
axis.set(xlabel=r"$p\,t$", ylabel=r"$\theta/\alpha$", xlim=(0, 20))
axis.legend()
plt.show()

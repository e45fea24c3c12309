"""The sketch of block, inerter and clutched pair, with every symbol."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, Circle, Polygon, Rectangle

STEEL, STONE, INK = "#9db4c8", "#e4ddd0", "#222222"


def arrow(axis: Axes, start: tuple[float, float], end: tuple[float, float], style: str = "-|>") -> None:
    """An arrow or, with style <|-|>, a dimension."""
    axis.annotate("", end, start, arrowprops={"arrowstyle": style, "color": INK, "shrinkA": 0, "shrinkB": 0, "linewidth": 1})


def block(axis: Axes) -> None:
    """A block that turns about its toe O."""
    b, h, rotation = 1.0, 2.4, np.radians(9)
    slenderness = np.arctan(b / h)

    def place(x: float, y: float) -> tuple[float, float]:
        """A point of the block, from O along its base and its side."""
        return x * np.cos(rotation) + y * np.sin(rotation), -x * np.sin(rotation) + y * np.cos(rotation)

    axis.fill_between([-3.4, 1.4], -0.35, 0, color="0.85", linewidth=0)
    axis.plot([-3.4, 1.4], [0, 0], color=INK, linewidth=1)
    axis.add_patch(Polygon([place(0, 0), place(-2 * b, 0), place(-2 * b, 2 * h), place(0, 2 * h)], facecolor=STONE, edgecolor=INK))
    centre = place(-b, h)
    axis.plot(*zip((0, 0), centre, strict=True), color=INK, linewidth=1)
    axis.plot([0, 0], [0, 3.2], color=INK, linewidth=0.8, linestyle="--")
    axis.plot(*centre, "o", color=INK, markersize=4)
    axis.text(centre[0] - 0.1, centre[1] + 0.15, "$C$", ha="right")
    axis.text(-0.05, -0.3, "$O$", ha="center")
    axis.text(place(-2 * b, 0)[0] - 0.08, place(-2 * b, 0)[1] + 0.08, "$O'$", ha="right")
    axis.text(-0.5, 1.0, "$R$")
    # From the line O-C to the side is α, from the vertical to the side θ.
    line, side = 90 + np.degrees(slenderness - rotation), 90 - np.degrees(rotation)
    axis.add_patch(Arc((0, 0), 3.6, 3.6, theta1=side, theta2=line, color=INK))
    axis.text(-0.2, 1.87, r"$\alpha$")
    axis.add_patch(Arc((0, 0), 5.6, 5.6, theta1=side, theta2=90, color=INK))
    axis.text(0.14, 2.88, r"$\theta$")
    axis.add_patch(Arc((0, 0), 2.4, 2.4, theta1=90, theta2=line, color=INK))
    axis.text(-0.17, 1.25, r"$\delta$", ha="center")
    arrow(axis, place(-2 * b, 2 * h + 0.2), place(0, 2 * h + 0.2), "<|-|>")
    axis.text(*place(-b, 2 * h + 0.3), "$2b$", ha="center")
    arrow(axis, place(0.25, 0.1), place(0.25, 2 * h), "<|-|>")
    axis.text(*place(0.33, 1.5 * h), "$2h$")
    arrow(axis, centre, (centre[0], centre[1] - 0.9))
    axis.text(centre[0] - 0.08, centre[1] - 0.85, "$mg$", ha="right")
    arrow(axis, (-0.6, -0.62), (0.4, -0.62))
    axis.text(-0.7, -0.62, r"$\ddot u_g$", ha="right", va="center")
    # The device: from the centre of mass to a wall that moves with the ground.
    wall, height = -3.0, centre[1]
    axis.add_patch(Rectangle((wall - 0.3, 0), 0.3, height + 0.6, facecolor="0.85", edgecolor="none"))
    axis.plot([wall, wall], [0, height + 0.6], color=INK, linewidth=1)
    axis.plot([wall, centre[0]], [height, height], color=INK, linewidth=1)
    axis.add_patch(Rectangle((wall + 0.4, height - 0.22), 0.75, 0.44, facecolor=STEEL, edgecolor=INK, zorder=3))
    axis.text(wall + 0.775, height - 0.02, r"$m_r$", ha="center", va="center", zorder=4)
    arrow(axis, (wall + 0.4, height + 0.5), (wall + 1.15, height + 0.5))
    axis.text(wall + 0.78, height + 0.58, "$u$", ha="center")
    axis.set(title="block on its toe $O$", xlim=(-3.4, 1.9), ylim=(-1.0, 5.6))


def rack(axis: Axes, start: float, end: float, top: float) -> None:
    """A rack with its teeth up."""
    teeth = np.arange(start, end, 0.16)
    x = np.column_stack([teeth, teeth + 0.08]).ravel()
    y = np.tile([top - 0.08, top], len(teeth))
    axis.add_patch(
        Polygon(
            [*zip(x, y, strict=True), (end, top - 0.08), (end, top - 0.3), (start, top - 0.3)], facecolor=STEEL, edgecolor=INK, zorder=2
        )
    )


def inerter(axis: Axes) -> None:
    """A rack, a pinion and a flywheel."""
    rack(axis, -2.2, 2.2, 0)
    pinion, flywheel = 0.5, 1.5
    hub = (0.0, pinion)
    axis.add_patch(Circle(hub, flywheel, facecolor="#d6e0ea", edgecolor=INK, zorder=1))
    axis.add_patch(Circle(hub, pinion, facecolor=STEEL, edgecolor=INK, zorder=2))
    axis.plot(*hub, "o", color=INK, markersize=4)
    arrow(axis, hub, (hub[0] - pinion * np.sin(0.6), hub[1] + pinion * np.cos(0.6)))
    axis.text(-0.38, 1.02, r"$\rho_1$", ha="right")
    arrow(axis, hub, (hub[0] + flywheel * np.cos(0.6), hub[1] + flywheel * np.sin(0.6)))
    axis.text(0.75, 1.2, "$R_1$")
    axis.text(-0.9, 1.45, "$m_{w1}$")
    arrow(axis, (1.4, -0.6), (2.2, -0.6))
    axis.text(1.8, -0.9, "$u_2 - u_1$", ha="center")
    arrow(axis, (2.95, -0.18), (2.2, -0.18))
    axis.text(2.55, -0.1, "$F_1$", ha="center")
    formula = r"$F_1 = m_r\,(\ddot u_2 - \ddot u_1)$" + "\n" + r"$m_r = \frac{1}{2}\,m_{w1} R_1^2/\rho_1^2$,  $\sigma = m_r/m$"
    axis.text(0, -1.2, formula, ha="center", va="top", linespacing=1.7)
    axis.set(title="inerter: rack, pinion, flywheel", xlim=(-2.6, 3.1), ylim=(-2.6, 2.3))


def pair(axis: Axes) -> None:
    """Two flywheels on one rack, from above."""
    axis.add_patch(Rectangle((-2.4, -0.3), 4.8, 0.3, facecolor=STEEL, edgecolor=INK))
    axis.text(-2.4, -0.6, "rack")
    arrow(axis, (1.6, -0.55), (2.4, -0.55))
    axis.text(2.0, -0.9, r"$\dot u$", ha="center")
    for x, number, gap, state, speed in [(-1.2, 1, 0.0, "engaged", r"$w = \dot u/R$"), (1.2, 2, 0.16, "released", r"$w$ falls")]:
        axis.plot([x, x], [-0.15, 1.2], color=INK, linewidth=2)
        axis.add_patch(Rectangle((x - 0.3, -0.34), 0.6, 0.38, facecolor="#d6e0ea", edgecolor=INK, zorder=3))
        for y in (1.2, 1.28 + gap):
            axis.add_patch(Rectangle((x - 0.45, y), 0.9, 0.08, facecolor=INK))
        axis.plot([x, x], [1.36 + gap, 2.0], color=INK, linewidth=2)
        axis.add_patch(Rectangle((x - 0.85, 2.0), 1.7, 0.4, facecolor="#d6e0ea", edgecolor=INK))
        axis.text(x, 2.18, f"flywheel {number}", ha="center", va="center")
        axis.text(x, 2.75, f"{state}: {speed}", ha="center")
    axis.text(0, 1.25, "clutches", ha="center")
    axis.text(0, 0.35, "pinions", ha="center")
    axis.text(0, 0.97, "$K, C, F_c$", ha="center", fontsize="small")
    formula = "engaged while $\\ddot u/\\dot u > 0$ (Eq. 10);\none flywheel for each sign of $\\dot u$"
    axis.text(0, -1.1, formula, ha="center", va="top", linespacing=1.5)
    axis.set(title="clutched pair, from above", xlim=(-2.8, 2.8), ylim=(-2.5, 3.4))


figure, axes = plt.subplot_mosaic([["block", "inerter"], ["block", "pair"]], figsize=(8, 7), layout="constrained")
for name, draw in {"block": block, "inerter": inerter, "pair": pair}.items():
    draw(axes[name])
    axes[name].set_aspect("equal")
    axes[name].axis("off")
plt.show()

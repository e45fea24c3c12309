r"""
Fragility over artificial records
=================================

The probability that a block overturns, over the peak ground velocity, from 120 motions: filtered noise, shaped in time, with a velocity
pulse. They stand for records, which this site has none of: read yours with :py:meth:`sprag.Record.read`. Ticks are motions that
overturned the block (above) or did not (below); bands are those of 95 %. The pair's is wide, since few motions overturn the block that
has it.
"""

import matplotlib.pyplot as plt
import numpy as np
import sprag

STEP = 0.01


def artificial_record(random: np.random.Generator, number: int) -> sprag.Record:
    """A near-fault motion that is nobody's."""
    t = np.arange(0.0, 20.0, STEP)
    # Noise through a ground layer of 0.4 s (Kanai 1957, Tajimi 1960), without what is slower than 0.2 Hz.
    frequency = np.fft.rfftfreq(len(t), STEP)
    ratio = frequency * 0.4
    layer = (1 + 1.2j * ratio) / (1 - ratio**2 + 1.2j * ratio) * (frequency / 0.2) ** 2 / (1 + (frequency / 0.2) ** 2)
    noise = np.fft.irfft(np.fft.rfft(random.normal(size=len(t))) * layer, len(t))
    noise *= (t / 5) ** 2 * np.exp(2 * (1 - t / 5)) / noise.std()
    # The acceleration of a velocity pulse of one cycle and a half.
    period = random.uniform(0.6, 3.0)
    velocity = np.cos(2 * np.pi * (t - 6) / period) * np.exp(-(((t - 6) / (0.6 * period)) ** 2))
    strength = random.lognormal(np.log(0.6), 0.5)
    acceleration = np.gradient(velocity, STEP) * strength + random.lognormal(np.log(0.8), 0.4) * noise
    return sprag.Record(acceleration, time_step_s=STEP, name=f"motion {number}")


random = np.random.default_rng(2019)
records = [artificial_record(random, number) for number in range(120)]
block = sprag.Block(size_m=1.0, slenderness_deg=15.0, restitution=0.85)
devices = [sprag.NoDevice(), sprag.Inerter(mass_ratio=1.0), sprag.ClutchedPair(mass_ratio=1.0)]
runs = [sprag.simulate(sprag.Scene(block=block, device=devices, ground=record)) for record in records]

pgv = np.array([record.pgv_m_s for record in records])
at = np.linspace(0.1, 2.0, 200)
figure, axis = plt.subplots(figsize=(9, 5), layout="constrained")
for device, of_device in enumerate(zip(*runs, strict=True)):
    overturned = np.array([run.outcome.overturned for run in of_device])
    fit = sprag.fragility(intensity=pgv, overturned=overturned)
    (line,) = axis.plot(at, fit.probability(at), label=f"{of_device[0].device}, median {fit.median:.2f} m/s")
    axis.fill_between(at, *fit.band(at), color=line.get_color(), alpha=0.15)
    for fell, low in [(True, 1.02), (False, -0.05)]:
        axis.vlines(pgv[overturned == fell], low + 0.03 * device, low + 0.03 * device + 0.02, color=line.get_color(), linewidth=0.7)
axis.set(xlabel="PGV (m/s)", ylabel="probability of overturning", xlim=(at[0], at[-1]))
figure.legend(loc="outside lower center", ncols=3)
plt.show()

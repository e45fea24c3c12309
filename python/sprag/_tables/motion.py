"""Ground motions as frozen values. Made by generate_tables.py from the schema of scenes: do not edit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from .._table import Table


@dataclass(frozen=True, kw_only=True, repr=False)
class Sine(Table):
    """One cycle of a sine: an amplitude and a frequency.

    Attributes
    ----------
    amplitude_ratio
        Amplitude a_g/(g tan α), or a_g/(gα) for the slender model; of horizontal motions; from -1e+06 to
        1e+06.
    amplitude_g
        Amplitude a_g; from -1000 to 1000.
    amplitude_m_s2
        Amplitude a_g; from -10000 to 10000.
    frequency_ratio
        Frequency ω_g/p; or give frequency_hz; from 0.001 to 10000.
    frequency_hz
        Frequency; or give frequency_ratio; from 0.001 to 1000.
    scale
        Factor on the whole motion; from -1000 to 1000; 1.0 by default.
    start_s
        Start; from 0 to 10000; 0.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "ground"
    _fixed: ClassVar[dict[str, str]] = {"motion": "sine"}

    amplitude_ratio: float | None = None
    amplitude_g: float | None = None
    amplitude_m_s2: float | None = None
    frequency_ratio: float | None = None
    frequency_hz: float | None = None
    scale: float | None = None
    start_s: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Cosine(Table):
    """One cycle of a cosine: an amplitude and a frequency.

    Attributes
    ----------
    amplitude_ratio
        Amplitude a_g/(g tan α), or a_g/(gα) for the slender model; of horizontal motions; from -1e+06 to
        1e+06.
    amplitude_g
        Amplitude a_g; from -1000 to 1000.
    amplitude_m_s2
        Amplitude a_g; from -10000 to 10000.
    frequency_ratio
        Frequency ω_g/p; or give frequency_hz; from 0.001 to 10000.
    frequency_hz
        Frequency; or give frequency_ratio; from 0.001 to 1000.
    scale
        Factor on the whole motion; from -1000 to 1000; 1.0 by default.
    start_s
        Start; from 0 to 10000; 0.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "ground"
    _fixed: ClassVar[dict[str, str]] = {"motion": "cosine"}

    amplitude_ratio: float | None = None
    amplitude_g: float | None = None
    amplitude_m_s2: float | None = None
    frequency_ratio: float | None = None
    frequency_hz: float | None = None
    scale: float | None = None
    start_s: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class HalfSine(Table):
    """Half a cycle of a sine: an amplitude and a frequency.

    Attributes
    ----------
    amplitude_ratio
        Amplitude a_g/(g tan α), or a_g/(gα) for the slender model; of horizontal motions; from -1e+06 to
        1e+06.
    amplitude_g
        Amplitude a_g; from -1000 to 1000.
    amplitude_m_s2
        Amplitude a_g; from -10000 to 10000.
    frequency_ratio
        Frequency ω_g/p; or give frequency_hz; from 0.001 to 10000.
    frequency_hz
        Frequency; or give frequency_ratio; from 0.001 to 1000.
    scale
        Factor on the whole motion; from -1000 to 1000; 1.0 by default.
    start_s
        Start; from 0 to 10000; 0.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "ground"
    _fixed: ClassVar[dict[str, str]] = {"motion": "half-sine"}

    amplitude_ratio: float | None = None
    amplitude_g: float | None = None
    amplitude_m_s2: float | None = None
    frequency_ratio: float | None = None
    frequency_hz: float | None = None
    scale: float | None = None
    start_s: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Rectangular(Table):
    """Constant for a while: an amplitude and a duration.

    Attributes
    ----------
    amplitude_ratio
        Amplitude a_g/(g tan α), or a_g/(gα) for the slender model; of horizontal motions; from -1e+06 to
        1e+06.
    amplitude_g
        Amplitude a_g; from -1000 to 1000.
    amplitude_m_s2
        Amplitude a_g; from -10000 to 10000.
    duration_s
        Length of a rectangular pulse; or give duration_ratio; from 1e-06 to 10000.
    duration_ratio
        Length of a rectangular pulse, in 1/p; or give duration_s; from 1e-06 to 10000.
    scale
        Factor on the whole motion; from -1000 to 1000; 1.0 by default.
    start_s
        Start; from 0 to 10000; 0.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "ground"
    _fixed: ClassVar[dict[str, str]] = {"motion": "rectangular"}

    amplitude_ratio: float | None = None
    amplitude_g: float | None = None
    amplitude_m_s2: float | None = None
    duration_s: float | None = None
    duration_ratio: float | None = None
    scale: float | None = None
    start_s: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Ricker(Table):
    """Symmetric Ricker wavelet: an amplitude and a frequency.

    Attributes
    ----------
    amplitude_ratio
        Amplitude a_g/(g tan α), or a_g/(gα) for the slender model; of horizontal motions; from -1e+06 to
        1e+06.
    amplitude_g
        Amplitude a_g; from -1000 to 1000.
    amplitude_m_s2
        Amplitude a_g; from -10000 to 10000.
    frequency_ratio
        Frequency ω_g/p; or give frequency_hz; from 0.001 to 10000.
    frequency_hz
        Frequency; or give frequency_ratio; from 0.001 to 1000.
    scale
        Factor on the whole motion; from -1000 to 1000; 1.0 by default.
    start_s
        Start; from 0 to 10000; 0.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "ground"
    _fixed: ClassVar[dict[str, str]] = {"motion": "ricker"}

    amplitude_ratio: float | None = None
    amplitude_g: float | None = None
    amplitude_m_s2: float | None = None
    frequency_ratio: float | None = None
    frequency_hz: float | None = None
    scale: float | None = None
    start_s: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class MavroeidisPapageorgiou(Table):
    """Near-fault velocity pulse: a velocity amplitude, a frequency, oscillations, phase_deg.

    Attributes
    ----------
    velocity_amplitude_m_s
        Velocity amplitude A of a Mavroeidis-Papageorgiou pulse; from -100 to 100.
    frequency_ratio
        Frequency ω_g/p; or give frequency_hz; from 0.001 to 10000.
    frequency_hz
        Frequency; or give frequency_ratio; from 0.001 to 1000.
    oscillations
        Oscillations γ of a Mavroeidis-Papageorgiou pulse; above 1, to 100.
    phase_deg
        Phase ν of a Mavroeidis-Papageorgiou pulse; from -360 to 360.
    scale
        Factor on the whole motion; from -1000 to 1000; 1.0 by default.
    start_s
        Start; from 0 to 10000; 0.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "ground"
    _fixed: ClassVar[dict[str, str]] = {"motion": "mavroeidis-papageorgiou"}

    velocity_amplitude_m_s: float | None = None
    frequency_ratio: float | None = None
    frequency_hz: float | None = None
    oscillations: float | None = None
    phase_deg: float | None = None
    scale: float | None = None
    start_s: float | None = None


Motion = Sine | Cosine | HalfSine | Rectangular | Ricker | MavroeidisPapageorgiou

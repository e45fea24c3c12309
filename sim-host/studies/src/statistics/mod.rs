//! Seismic demand models and overturning fragility, from the results of many runs (Thiers-Moggia and Málaga-Chuquitaype 2019,
//! Section 6, Eq. 24-26), with the uncertainty of each.
//!
//! - [`power_law`]: the median demand as a power of the intensity measure.
//! - [`efficiency`]: intensity measures ranked by how little demand scatters about that law.
//! - [`mod@fragility`]: the lognormal probability of overturning by maximum likelihood; [`fragility_curve`]: what it says at an
//!   intensity; [`observation`]: the runs that it is fitted to.
//! - [`bootstrap`]: its bands by resampling.
//! - [`paired`]: how much two designs differ under the same motions; [`mod@sign_test`]: whether pairs differ one way.
//! - [`proportion`]: what a share of a sample says of a probability.
//! - [`level`], [`mod@quantile`]: confidence levels and bands, quantiles of a sample.
//! - [`front`]: which points no other one betters.
//! - [`normal`], [`student`]: the distributions behind them.
//!
//! Logarithms are natural. Every function gives the same bits on every machine and for every number of threads.

pub mod bootstrap;
pub mod efficiency;
pub mod fragility;
pub mod fragility_curve;
pub mod front;
pub mod level;
pub mod normal;
pub mod observation;
pub mod paired;
pub mod power_law;
mod probit;
pub mod proportion;
pub mod quantile;
pub(crate) mod resample;
pub mod sign_test;
pub mod student;
#[cfg(test)]
mod tests;

pub use bootstrap::{Bootstrap, BootstrapError, CurveBand, FragilityBands, NoEstimateCounts, fragility_bands};
pub use efficiency::{Efficiency, IntensityMeasure, RankedMeasure, UnfittedMeasure, UnfittedReason, rank};
pub use fragility::{Fragility, FragilityError, fragility};
pub use fragility_curve::FragilityCurve;
pub use level::{Level, LevelError};
pub use observation::{Observation, ObservationError};
pub use paired::{Groups, Paired};
pub use power_law::{DemandPoint, PowerLaw, PowerLawError};
pub use quantile::{order_statistic, quantile, quantiles};
pub use sign_test::sign_test;
pub use sprag_report::band::Band;

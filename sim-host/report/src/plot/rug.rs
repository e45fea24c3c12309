//! Ticks at the edges of a panel for runs that have an outcome only.

use super::layer::units;
use super::palette::{INK, device_look, hex};
use super::panel::Panel;

/// Most that the rugs above or below the curves take (px), and a lane of them.
const RUG_PX: f64 = 30.0;
const RUG_LANE_PX: f64 = 7.0;
const RUG_GAP_PX: f64 = 3.0;

/// Runs that have an outcome only.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rug {
    /// Intensities of those that stood: below.
    pub stood: Vec<f64>,
    /// Of those that overturned: above.
    pub overturned: Vec<f64>,
}

impl Rug {
    /// Appends the ticks of number `device` of `devices`, in lanes of their own above the height 1 and below 0 of `panel`.
    pub(super) fn write(&self, svg: &mut String, panel: &Panel<'_>, device: usize, devices: usize) {
        let lane_px = rug_lane_px(devices);
        let offset = RUG_GAP_PX + device as f64 * lane_px;
        let (zero, one) = (panel.position_px((0.0, 0.0)).1, panel.position_px((0.0, 1.0)).1);
        let mut path = String::new();
        for (values, top_px) in [(&self.stood, zero + offset), (&self.overturned, one - offset - lane_px)] {
            for &value in values {
                let x = panel.position_px((value, 0.0)).0;
                path.push_str(&format!("M{} {}v{}", units(x), units(top_px), units(lane_px - 1.0)));
            }
        }
        if !path.is_empty() {
            let colour = hex(device_look(device).colour);
            svg.push_str(&format!("<path d=\"{path}\" stroke=\"{colour}\" stroke-width=\"8\" stroke-opacity=\"0.7\"/>\n"));
        }
    }
}

/// Appends the ticks of a legend's entry around a position in pixels.
pub(super) fn write_rug_key(svg: &mut String, (x_px, y_px): (f64, f64)) {
    let tick = |at_px: f64| format!("M{} {}v{}", units(x_px + at_px), units(y_px - 4.0), units(8.0));
    let ticks = [-12.0, -7.0, -5.0, 0.0, 6.0].map(tick).concat();
    svg.push_str(&format!("<path d=\"{ticks}\" stroke=\"{}\" stroke-width=\"8\"/>\n", hex(INK)));
}

/// What the lanes of `devices` take above or below the curves (px).
pub(super) fn rugs_px(devices: usize) -> f64 {
    2.0 * RUG_GAP_PX + devices as f64 * rug_lane_px(devices)
}

fn rug_lane_px(devices: usize) -> f64 {
    (RUG_PX / devices.max(1) as f64).min(RUG_LANE_PX)
}

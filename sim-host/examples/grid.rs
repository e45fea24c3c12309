//! Probe.
use sprag_shared::{block::Geometry, structure::DeviceKind, taylor::Taylor};
use sprag_sim_host::batch::case::*;
fn main() {
    let free: f64 = std::env::args().nth(1).unwrap().parse().unwrap();
    let n: usize = std::env::args().nth(2).unwrap().parse().unwrap();
    let m = Taylor::adaptive(TIGHT);
    for geometry in [Geometry::Full, Geometry::Slender] {
        for device in [DeviceKind::None, DeviceKind::Inerter, DeviceKind::ClutchedPair] {
            let t = std::time::Instant::now();
            let mut count = [0; 4];
            for pulse in [PulseShape::Sine, PulseShape::Cosine] {
                for i in 0..n {
                    for j in 0..n {
                        let c = Case {
                            geometry,
                            device,
                            pulse,
                            frequency_ratio: 0.2 + 7.8 * i as f64 / (n - 1) as f64,
                            amplitude_ratio: 1.0 + 9.0 * j as f64 / (n - 1) as f64,
                            free_time: free,
                            ..Case::default()
                        };
                        count[c.run(&m).unwrap().outcome as usize] += 1;
                    }
                }
            }
            println!("{geometry:?} {device:?} {:?} per cell {count:?}", t.elapsed() / (2 * n * n) as u32);
        }
    }
}

//! Options that say how many threads a command takes.

use clap::Args;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// A number of threads.
#[derive(Args, Clone, Copy, Debug, Default)]
pub struct ThreadArguments {
    /// Number of threads; one for each core by default. Results do not depend on it.
    #[arg(long, value_name = "N", value_parser = super::whole_number(1..=1024_u16))]
    pub threads: Option<u16>,
}

impl ThreadArguments {
    /// The threads, started.
    ///
    /// # Errors
    /// Threads that the system does not give.
    pub fn pool(self) -> anyhow::Result<ThreadPool> {
        let pool = ThreadPoolBuilder::new().num_threads(self.threads.map_or(0, usize::from)).build();
        pool.map_err(|error| anyhow::anyhow!("the threads cannot be started: {error}"))
    }
}

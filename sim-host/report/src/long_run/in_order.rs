//! Tasks worked out on many threads and taken in their order.

use std::ops::Range;

use rayon::prelude::*;

use crate::progress::Progress;

/// Tasks a thread that are in work at one time: enough that no thread waits long for the last of them, and memory stays small.
const WINDOW: usize = 64;

/// Works through `rows` by `task` rows at a time on rayon's threads, and takes what comes out in order on this one. `work` gives nothing
/// once it was interrupted; what had been worked out before, without a gap, is taken, and then the answer is `false`.
///
/// Memory is that of some tasks, however many there are.
///
/// # Errors
/// The first error of `work` or `take`, after what came before it was taken.
pub fn in_order<T: Send, E: Send>(
    rows: Range<usize>,
    task: usize,
    work: impl Fn(Range<usize>) -> Result<Option<T>, E> + Sync,
    mut take: impl FnMut(T) -> Result<(), E>,
) -> Result<bool, E> {
    let task = task.max(1);
    let window = task * WINDOW * rayon::current_num_threads();
    let mut start = rows.start;
    while start < rows.end {
        let end = rows.end.min(start + window);
        // Begun one after another, so that a stop leaves few results behind a gap.
        let firsts = (start..end).step_by(task).par_bridge();
        let mut found: Vec<_> = firsts.map(|first| (first, work(first..end.min(first + task)))).collect();
        found.sort_unstable_by_key(|(first, _)| *first);
        for (_, result) in found {
            match result? {
                Some(result) => take(result)?,
                None => return Ok(false),
            }
        }
        start = end;
    }
    Ok(true)
}

/// What `work` makes of each of `jobs`, on rayon's threads and in their order; `progress` hears of each.
///
/// # Errors
/// The first error by order, not by time.
pub fn all_in_order<'j, J: Sync, R: Send, E: Send>(
    jobs: &'j [J],
    progress: &Progress,
    work: impl Fn(&'j J) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    progress.begin(jobs.len() as u64);
    let mut results = Vec::with_capacity(jobs.len());
    let one = |place: Range<usize>| {
        let result = jobs[place].iter().map(&work).collect::<Result<Vec<R>, E>>()?;
        progress.step();
        Ok(Some(result))
    };
    in_order(0..jobs.len(), 1, one, |result| {
        results.extend(result);
        Ok(())
    })?;
    Ok(results)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn results_come_in_order_on_any_number_of_threads() {
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut taken = Vec::new();
            let whole = pool.install(|| {
                in_order::<_, ()>(
                    5..10_000,
                    7,
                    |rows| Ok(Some(rows.collect::<Vec<_>>())),
                    |rows| {
                        taken.extend(rows);
                        Ok(())
                    },
                )
            });
            assert_eq!(whole, Ok(true));
            assert!(taken.iter().copied().eq(5..10_000), "{threads}");
        }
    }

    #[test]
    fn what_was_done_before_a_stop_is_taken() {
        let taken = AtomicUsize::new(0);
        let take = |rows: Range<usize>| {
            assert_eq!(taken.swap(rows.end, Ordering::Relaxed), rows.start);
            Ok(())
        };
        assert_eq!(in_order(0..1000, 10, |rows| Ok((rows.start < 400).then_some(rows)), take), Ok(false));
        assert_eq!(taken.load(Ordering::Relaxed), 400);
        taken.store(0, Ordering::Relaxed);
        assert_eq!(in_order(0..1000, 10, |rows| if rows.start == 300 { Err("no") } else { Ok(Some(rows)) }, take), Err("no"));
        assert_eq!(taken.load(Ordering::Relaxed), 300);
    }

    #[test]
    fn of_many_errors_the_first_by_order_is_given() {
        let jobs: Vec<u32> = (0..5000).collect();
        let progress = Progress::new("jobs");
        assert_eq!(all_in_order::<_, _, ()>(&jobs, &progress, |job| Ok(2 * job)), Ok((0..5000).map(|job| 2 * job).collect()));
        assert_eq!(all_in_order(&jobs, &progress, |&job| if job % 1000 == 77 { Err(job) } else { Ok(job) }), Err(77));
    }
}

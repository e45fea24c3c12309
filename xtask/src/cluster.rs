//! A study as an array job of a real Slurm, on this machine alone.

use crate::{
    process::{captured, output, run as done},
    scratch::empty,
    stop::Stop,
    tools,
};
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

/// How long the daemons and the array may take, on a busy machine.
const PATIENCE: Duration = Duration::from_secs(120);

/// A small map whose cells are simulated one by one.
const MAP: [&str; 12] = [
    "map",
    "scene.toml",
    "--formats",
    "csv,svg",
    "--set",
    "map.x.cells=20",
    "--set",
    "map.y.cells=16",
    "--set",
    "ground.0.motion=\"half-sine\"",
    "--out",
    "collected",
];

/// Plans a map in parts, makes them by a Slurm array of which one task is cancelled and sent again, and compares what is collected with the
/// map that was not divided. `sprag` is the program, built already.
///
/// # Errors
/// If Slurm cannot be installed or started, or a byte differs.
pub fn run(root: &Path, sprag: &Path) -> Result<(), Stop> {
    tools::need_slurm()?;
    let folder = root.join("target/slurm");
    let at = |name: &str| folder.join(name);
    let cannot = |path: &Path, error: std::io::Error| Stop::failed(format!("{}: {error}", path.display()));
    ["", "state", "spool"].iter().try_for_each(|name| empty(&at(name)))?;
    let scene = root.join("scenes/figure08.toml");
    fs::copy(&scene, at("scene.toml")).map_err(|error| cannot(&scene, error))?;
    let cluster = Cluster::start(&folder)?;
    let program = sprag.parent().ok_or_else(|| Stop::failed(format!("{}: no folder", sprag.display())))?;
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap_or_default());
    let command = |name: &str, words: &[&str]| {
        let mut command = Command::new(name);
        command.args(words).current_dir(&folder).env("SLURM_CONF", &cluster.settings).env("PATH", &path);
        command
    };
    let sprag = |words: &[&str]| command("sprag", words);
    let plan = [&["plan", "parts", "--parts", "4", "--slurm", "--"], &MAP[..]].concat();
    fs::write(at("job.sh"), output(&mut sprag(&plan))?).map_err(|error| cannot(&at("job.sh"), error))?;
    // Held, so that the task is cancelled before it is done.
    let job = output(&mut command("sbatch", &["--parsable", "--hold", "job.sh"]))?;
    let job = job.trim();
    done(&mut command("scancel", &[&format!("{job}_3")]))?;
    done(&mut command("scontrol", &["release", job]))?;
    let start = Instant::now();
    while !captured(&mut command("squeue", &["--noheader", "--jobs", job]))?.trim().is_empty() {
        if start.elapsed() > PATIENCE {
            return Err(Stop::failed("the array has not ended"));
        }
        sleep(Duration::from_millis(200));
    }
    let part = |number: u32| at(&format!("parts/part-{number:05}.parquet")).is_file();
    if [1, 2, 3, 4].map(part) != [true, true, false, true] {
        return Err(Stop::failed("the parts are not those of the tasks that were not cancelled"));
    }
    done(&mut command("sbatch", &["--wait", "job.sh"]))?;
    done(&mut sprag(&["collect", "parts"]))?;
    done(&mut sprag(&[&MAP[..MAP.len() - 1], &["whole"]].concat()))?;
    for name in ["map.csv", "map.svg", "rotation.svg"] {
        let read = |folder: &str| fs::read(at(folder).join(name)).map_err(|error| cannot(&at(folder), error));
        if read("collected")? != read("whole")? {
            return Err(Stop::failed(format!("{name} is not that of the map that was not divided")));
        }
    }
    Ok(())
}

/// Slurm's two daemons, which end with this value.
struct Cluster {
    settings: PathBuf,
    daemons: Vec<Child>,
}

impl Cluster {
    /// Starts a controller and a node in `folder`, on this machine's own address and as this user, and waits until the node is idle.
    fn start(folder: &Path) -> Result<Cluster, Stop> {
        let user = output(Command::new("id").arg("-un"))?;
        let (user, place) = (user.trim(), folder.display());
        let settings = folder.join("slurm.conf");
        // One processor, so that tasks run one after another; a look for work every second, not every minute.
        let text = format!(
            "\
ClusterName=sprag
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=26817
SlurmdPort=26818
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/none
CredType=cred/none
StateSaveLocation={place}/state
SlurmdSpoolDir={place}/spool
SlurmctldPidFile={place}/slurmctld.pid
SlurmdPidFile={place}/slurmd.pid
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=1,sched_min_interval=0,batch_sched_delay=0
MpiDefault=none
ReturnToService=2
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
NodeName=localhost NodeAddr=127.0.0.1 CPUs=1 State=UNKNOWN
PartitionName=all Nodes=localhost Default=YES State=UP
"
        );
        fs::write(&settings, text).map_err(|error| Stop::failed(format!("{}: {error}", settings.display())))?;
        let mut cluster = Cluster { settings, daemons: Vec::new() };
        for (daemon, words) in [("slurmctld", &["-D"][..]), ("slurmd", &["-D", "-N", "localhost"])] {
            let log = fs::File::create(folder.join(daemon).with_extension("log"));
            let log = log.map_err(|error| Stop::failed(format!("{}: {error}", folder.display())))?;
            let mut command = Command::new(daemon);
            command.args(words).env("SLURM_CONF", &cluster.settings).stdin(Stdio::null()).stdout(Stdio::null()).stderr(log);
            cluster.daemons.push(command.spawn().map_err(|error| Stop::usage(format!("{daemon}: {error}")))?);
        }
        let start = Instant::now();
        let mut ask = Command::new("sinfo");
        ask.args(["--noheader", "--format=%t"]).env("SLURM_CONF", &cluster.settings);
        while captured(&mut ask)?.trim() != "idle" {
            if start.elapsed() > PATIENCE {
                return Err(Stop::failed(format!("Slurm's node is not ready: see {place}/slurmctld.log and slurmd.log")));
            }
            sleep(Duration::from_millis(200));
        }
        Ok(cluster)
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        for daemon in &mut self.daemons {
            // Either may fail because it has ended already.
            _ = daemon.kill();
            _ = daemon.wait();
        }
    }
}

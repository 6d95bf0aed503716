#!/usr/bin/env bash
# Sweeps on a real Slurm of one node with docs/cluster/sweep.sbatch, kills a task on the way, submits the
# same again, and checks that no row is lost and none is there twice.
#
#   apt-get install slurmctld slurmd slurm-client munge
#   bash tests/slurm.sh
#
# Needs root, for munge and Slurm keep their keys and sockets from others, and the program
# target/fast/edgeline. Starts daemons of its own in target/slurm and ends them. Takes half a minute.
# Exit code 2 if Slurm cannot be started here.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD home=$PWD/target/slurm shards=4
export EDGELINE=$root/target/fast/edgeline SLURM_CONF=$home/slurm.conf

for tool in munged slurmctld slurmd sbatch; do
    command -v $tool >/dev/null || { echo "error: $tool is missing; see the head of $0" >&2; exit 2; }
done
rm -rf "$home"
mkdir -p "$home"/{state,spool,log}
daemons=()
trap 'kill "${daemons[@]}" 2>/dev/null; wait' EXIT

dd if=/dev/urandom of="$home/key" bs=1024 count=1 status=none
chmod 400 "$home/key"
munged --foreground --force --key-file="$home/key" --socket="$home/munge" --pid-file="$home/munge.pid" \
    --seed-file="$home/seed" --log-file="$home/log/munge" --num-threads=1 >"$home/log/munged" 2>&1 &
daemons+=($!)

node=$(hostname -s)
cat >"$SLURM_CONF" <<CONF
ClusterName=one
SlurmctldHost=$node(127.0.0.1)
SlurmctldPort=26817
SlurmdPort=26818
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$home/munge
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0
ReturnToService=2
StateSaveLocation=$home/state
SlurmdSpoolDir=$home/spool
SlurmctldPidFile=$home/slurmctld.pid
SlurmdPidFile=$home/slurmd.pid
SlurmctldLogFile=$home/log/slurmctld
SlurmdLogFile=$home/log/slurmd
NodeName=$node NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$node Default=YES State=UP
CONF
slurmctld -D -f "$SLURM_CONF" >/dev/null 2>&1 &
daemons+=($!)
slurmd -D -f "$SLURM_CONF" >/dev/null 2>&1 &
daemons+=($!)

# Waits until a command succeeds, some seconds at most.
until_true() {
    for _ in $(seq 300); do
        if "$@" >/dev/null 2>&1; then return 0; fi
        sleep 0.1
    done
    echo "error: waited in vain for: $*" >&2
    tail -n 20 "$home"/log/* >&2
    return 2
}
idle() { [[ $(sinfo -h -o %t) == idle ]]; }
drained() { [[ -z $(squeue -h) ]]; }
until_true idle || exit 2

cat >"$home/sweep.toml" <<'TOML'
[roller]
radius_m = 10e-3
young_pa = 210e9
poisson = 0.3
[block]
young_pa = 210e9
poisson = 0.3
[dimensionless]
W = 5e-4
S_l = { from = 2.0, to = 20.0, count = 40, spacing = "log" }
L_r = { from = 0.5, to = 0.99, count = 20 }
TOML
submit() {
    sbatch --quiet --array=1-$shards --output="$home/log/task-%a" --open-mode=append --chdir="$root" \
        docs/cluster/sweep.sbatch "$home/sweep.toml" "$home/rows" $shards --tolerance 1e-2
}
submit
some_rows() { (($(wc -l <"$home/rows/1.csv") > 20)); }
until_true some_rows
victim=$(pgrep -f "sweep $home/sweep.toml --shard 1/$shards")
kill -9 "$victim"
until_true drained
before=$(wc -l <"$home/rows/1.csv")
submit
until_true drained

"$EDGELINE" sweep "$home/sweep.toml" --tolerance 1e-2 --out "$home/whole.csv" >/dev/null
tail -q -n +2 "$home"/rows/*.csv | sort >"$home/parts"
tail -n +2 "$home/whole.csv" | sort >"$home/all"
cmp "$home/parts" "$home/all"
echo "task 1 was killed after $((before - 1)) rows; all $(wc -l <"$home/parts") rows are there once"

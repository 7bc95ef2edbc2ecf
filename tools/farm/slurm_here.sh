# A cluster of Slurm on this machine alone, for trials: its own configuration, keys and ports, nodes of one core. Sourced, never run.

# start_slurm FOLDER NODES: sets SLURM_CONF for what follows. Returns 1 where Slurm or munge is not installed.
start_slurm() {
    cluster=$1 nodes=$2
    local tool host user key=$1/munge.key node
    PATH=$PATH:/usr/sbin:/sbin
    for tool in slurmctld slurmd sbatch srun scontrol squeue munged; do
        command -v $tool >/dev/null || { echo "$tool is not installed (Debian: slurm-wlm, munge)" >&2 && return 1; }
    done
    host=$(uname -n) user=$(id -un)
    mkdir -p "$cluster/state"
    # Whoever can read the key may run jobs here.
    (umask 077 && head -c 1024 /dev/urandom >"$key")
    # The folder may be one that others can write to, such as /tmp; the key is not.
    munged --force --key-file="$key" --socket="$cluster/munge.sock" --pid-file="$cluster/munge.pid" \
        --log-file="$cluster/munge.log" --seed-file="$cluster/munge.seed" 2>>"$cluster/start.log" || { cat "$cluster/start.log" >&2; return 2; }
    local port=$((20000 + $$ % 20000 / 64 * 64)) # several trials side by side
    # A task that is put back begins when its old credential has expired, and the queue is looked through again: not after the two
    # minutes and the one that Slurm takes by default. The next task begins when one has ended, as it does everywhere.
    cat >"$cluster/slurm.conf" <<END
ClusterName=trial
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$cluster/munge.sock,cred_expire=5
CredType=cred/munge
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool.%n
SlurmctldPidFile=$cluster/slurmctld.pid
SlurmdPidFile=$cluster/slurmd.%n.pid
SlurmctldLogFile=$cluster/slurmctld.log
SlurmdLogFile=$cluster/slurmd.%n.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SwitchType=switch/none
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=5
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=2
KillWait=10
NodeName=n[1-$nodes] NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1))$( ((nodes == 1)) || echo "-$((port + nodes))") CPUs=1 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP MaxTime=INFINITE
END
    sed -i "s/Port=\([0-9]*\)-\([0-9]*\) /Port=[\1-\2] /" "$cluster/slurm.conf"
    export SLURM_CONF=$cluster/slurm.conf
    slurmctld -c 2>>"$cluster/start.log" || { cat "$cluster/start.log" >&2; return 2; }
    for ((node = 1; node <= nodes; ++node)); do
        slurmd -N "n$node" 2>>"$cluster/start.log" || { cat "$cluster/start.log" >&2; return 2; }
    done
    for ((node = 0; node < 60; ++node)); do
        [[ $(sinfo --noheader --format %T 2>/dev/null) == idle ]] && return
        sleep 0.5
    done
    echo "the nodes do not answer; see $cluster/slurmctld.log" >&2
    return 2
}

# stop_slurm: ends what start_slurm has started, and no other.
stop_slurm() {
    local pid
    [[ -n ${cluster-} ]] || return 0
    scancel --user "$(id -un)" 2>/dev/null || true
    for pid in "$cluster"/slurmd.*.pid "$cluster/slurmctld.pid" "$cluster/munge.pid"; do
        [[ ! -s $pid ]] || kill "$(<"$pid")" 2>/dev/null || true
    done
}

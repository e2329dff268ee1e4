# A throw-away Slurm cluster of virtual nodes on this host, with authentication, ports and folder of its own: nothing else on the
# host is touched. To be sourced. Needs root, slurm-wlm and munge.

# Whether the port is free.
is_free() { ! (exec 3<>"/dev/tcp/127.0.0.1/$1") 2>/dev/null; }

# Prints the first of $1 free ports in a row, below those that the system assigns.
free_ports() {
  local first i
  for _ in {1..100}; do
    first=$((10000 + RANDOM % 20000))
    for ((i = 0; i < $1; ++i)); do is_free $((first + i)) || continue 2; done
    echo "$first"
    return
  done
  return 1
}

# A lost node is noticed in about ten seconds; requeued jobs wait for the lifetime of a credential, at least 5 s.
write_configuration() {  # $1 number of nodes
  local first i
  first=$(free_ports $(($1 + 1))) || return
  echo CgroupPlugin=cgroup/v1 >"$cluster/cgroup.conf"
  cat >"$cluster/slurm.conf" <<CONF
ClusterName=throwaway
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=$first
SlurmUser=root
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$cluster/munge.socket,cred_expire=5
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,sched_interval=1,bf_interval=1
SlurmdParameters=config_overrides
MessageTimeout=2
TCPTimeout=1
SlurmdTimeout=4
KillWait=2
ReturnToService=2
MailProg=/bin/true
SlurmctldPidFile=$cluster/slurmctld.pid
SlurmctldLogFile=$cluster/slurmctld.log
StateSaveLocation=$cluster/state
SlurmdPidFile=$cluster/slurmd.%n.pid
SlurmdLogFile=$cluster/slurmd.%n.log
SlurmdSpoolDir=$cluster/spool/%n
$(for ((i = 1; i <= $1; ++i)); do echo "NodeName=n$i NodeHostname=localhost NodeAddr=127.0.0.1 Port=$((first + i)) CPUs=2"; done)
PartitionName=throwaway Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
}

start_munge() {
  (umask 077 && head -c 128 /dev/urandom >"$cluster/munge.key")
  /usr/sbin/munged --force --key-file="$cluster/munge.key" --socket="$cluster/munge.socket" \
    --pid-file="$cluster/munge.pid" --log-file="$cluster/munge.log" --seed-file="$cluster/munge.seed"
}

all_nodes_are_idle() { [ "$(sinfo -h -o '%T %D' 2>/dev/null)" = "idle $1" ]; }

# Starts nodes n1 to n$2 with all that they keep in the folder $1; every command of Slurm then goes to this cluster.
start_cluster() {
  local i
  cluster=$1
  mkdir -p "$cluster/state"
  write_configuration "$2" || return
  export SLURM_CONF=$cluster/slurm.conf
  {
    start_munge && /usr/sbin/slurmctld -f "$SLURM_CONF" || return
    for ((i = 1; i <= $2; ++i)); do
      mkdir -p "$cluster/spool/n$i" && /usr/sbin/slurmd -N "n$i" -f "$SLURM_CONF" || return
    done
  } >"$cluster/start.log" 2>&1
  for _ in {1..100}; do all_nodes_are_idle "$2" && return; sleep .1; done
  return 1
}

daemon_of() { cat "$cluster/slurmd.$1.pid"; }

# The scripts that run on node $1, and the processes that they have started.
tasks_on() {
  local pids
  pids=$(pgrep -f "$cluster/spool/$1/job")
  while [ -n "$pids" ]; do
    echo "$pids"
    pids=$(pgrep -P "$(paste -sd, <<<"$pids")")
  done
}

# Their supervisors, one slurmstepd each.
steps_on() {
  local pid
  for pid in $(pgrep -f "$cluster/spool/$1/job"); do ps -o ppid= -p "$pid"; done | sort -u
}

kill_all() { [ $# -lt 2 ] || kill -s "$@" 2>/dev/null; }  # $1 signal, then processes, of which some may be gone

# Like a power cut: kills all processes of the node.
crash_node() { kill_all KILL $(daemon_of "$1") $(steps_on "$1") $(tasks_on "$1"); }

stop_cluster() {
  local node
  [ -n "${cluster-}" ] || return 0
  for node in "$cluster"/spool/*/; do crash_node "$(basename "$node")"; done 2>/dev/null
  kill_all KILL $(cat "$cluster"/{slurmctld,munge}.pid 2>/dev/null)
}

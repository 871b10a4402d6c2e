# Prints the state of a machine as "key=value" lines. Needs only a POSIX sh, such as busybox.
#
# Variable: depth, "brief" (before and after every run: only files of /proc and /sys) or "full". Values
# that cannot be read have no line.
PATH=$PATH:/usr/local/sbin:/usr/sbin:/sbin

emit() { [ -z "$2" ] || printf '%s=%s\n' "$1" "$2"; }
# The first line of a file, without a fork.
line() {
  text=
  [ -r "$1" ] && IFS= read -r text <"$1"
} 2>/dev/null
emit_file() {
  line "$2"
  emit "$1" "$text"
}

# ---- What can change from run to run

read -r load rest </proc/loadavg 2>/dev/null
emit load_average "$load"
read -r uptime rest </proc/uptime 2>/dev/null
emit uptime_s "$uptime"
while read -r key value rest; do
  case $key in
    MemTotal:) emit memory_total_kib "$value" ;;
    MemAvailable:) emit memory_available_kib "$value" ;;
  esac
done </proc/meminfo 2>/dev/null

# How long some program waited for a processor, and how long other virtual machines had ours (ticks
# of 10 ms), since the start.
while read -r kind rest; do
  [ "$kind" = some ] && emit cpu_wait_us "${rest##*total=}"
done </proc/pressure/cpu 2>/dev/null
read -r kind user nice system idle io irq soft_irq steal rest </proc/stat 2>/dev/null
emit cpu_stolen_ticks "$steal"

emit_file clock_source /sys/devices/system/clocksource/clocksource0/current_clocksource

# Of all cores: the governor (each kind once), the lowest and the highest frequency now.
governors= now_min= now_max=
for core in /sys/devices/system/cpu/cpu[0-9]*/cpufreq; do
  line "$core/scaling_governor"
  case " $governors " in *" $text "*) ;; *) governors="$governors${governors:+ }$text" ;; esac
  line "$core/scaling_cur_freq"
  if [ -n "$text" ]; then
    [ -n "$now_min" ] && [ "$now_min" -le "$text" ] || now_min=$text
    [ -n "$now_max" ] && [ "$now_max" -ge "$text" ] || now_max=$text
  fi
done
emit governor "$governors"
emit frequency_now_min_khz "$now_min"
emit frequency_now_max_khz "$now_max"
emit_file frequency_min_khz /sys/devices/system/cpu/cpu0/cpufreq/scaling_min_freq
emit_file frequency_max_khz /sys/devices/system/cpu/cpu0/cpufreq/scaling_max_freq
emit_file frequency_hardware_max_khz /sys/devices/system/cpu/cpu0/cpufreq/cpuinfo_max_freq

# The hottest of the zones.
hottest=
for zone in /sys/class/thermal/thermal_zone*; do
  line "$zone/temp"
  [ -z "$text" ] || [ "$text" -le "${hottest:--1000000}" ] 2>/dev/null || hottest=$text
done
emit temperature_mc "$hottest"

# How often the cores were slowed down for heat since the start (x86).
count=
for core in /sys/devices/system/cpu/cpu[0-9]*/thermal_throttle; do
  line "$core/core_throttle_count"
  [ -z "$text" ] || count=$((${count:-0} + text))
done
emit throttle_count "$count"

# Voltage and heat of a Raspberry Pi.
if command -v vcgencmd >/dev/null 2>&1; then
  throttled=$(vcgencmd get_throttled 2>/dev/null)
  case $throttled in throttled=*) emit throttled "${throttled#throttled=}" ;; esac
fi
[ "$depth" = full ] || exit 0

# ---- Properties of the machine

emit architecture "$(uname -m)"
emit kernel "$(uname -sr)"
while IFS='=' read -r key value; do
  [ "$key" = PRETTY_NAME ] && value=${value#\"} && emit system "${value%\"}"
done </etc/os-release 2>/dev/null
model=
while IFS=':' read -r key value; do
  case $key in
    "model name"* | "Model"*) model=${value# } ;;
  esac
done </proc/cpuinfo 2>/dev/null
emit cpu_model "$model"
cores=0
for core in /sys/devices/system/cpu/cpu[0-9]*; do
  [ -d "$core" ] && cores=$((cores + 1))
done
emit cores "$cores"
emit online_cores "$(grep -c '^processor' /proc/cpuinfo 2>/dev/null)"

for program in tether-sut tether-exec; do
  if command -v "$program" >/dev/null 2>&1; then
    printed=$("$program" --version 2>&1 </dev/null | head -n 1)
    emit "version_$program" "${printed:-prints nothing}"
  else
    emit "version_$program" none
  fi
done

# How tether-exec can stop a program: with a cgroup v2 below its own, or with signals.
freezer=signals
while read -r device folder type rest; do
  [ "$type" = cgroup2 ] || continue
  while IFS=: read -r number names path; do
    [ "$number" = 0 ] && [ -w "$folder$path/cgroup.procs" ] && freezer=cgroup
  done </proc/self/cgroup
  break
done </proc/mounts 2>/dev/null
emit freezer "$freezer"

if [ -r "${TETHER_BOARD_LOCK:-/tmp/tether-board.lock}" ]; then
  {
    read -r pid rest
    IFS= read -r name
  } <"${TETHER_BOARD_LOCK:-/tmp/tether-board.lock}"
  [ -d "/proc/$pid" ] && emit held_by "$name"
fi

# Programs that take 5 % of a core or more over a second, except this script.
ticks() {
  for process in /proc/[0-9]*; do
    { IFS= read -r text <"$process/stat"; } 2>/dev/null || continue
    printf '%s %s\n' "$1" "$text"
  done
}
busy=$({
  ticks 1
  sleep 1
  ticks 2
} | awk -v own="$$" '
  { match($0, /\(.*\)/); name = substr($0, RSTART + 1, RLENGTH - 2); pid = $2
    split(substr($0, RSTART + RLENGTH + 1), field, " ")
    ticks = field[12] + field[13]
    if ($1 == 1) before[pid] = ticks
    else if (pid in before && pid != own && ticks - before[pid] >= 5)
      if (n++ < 6) printf "%s%s %d%%", (n > 1 ? ", " : ""), name, ticks - before[pid] }')
emit busy "${busy:-none}"

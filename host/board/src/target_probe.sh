# Tells what a machine is and how it is doing, a "key=value" line each. POSIX sh, busybox will do.
#
# Given: depth, "brief" (around every run: files of /proc and /sys only) or "full". What cannot be
# read has no line.
PATH=$PATH:/usr/local/sbin:/usr/sbin:/sbin

tell() { [ -z "$2" ] || printf '%s=%s\n' "$1" "$2"; }
# The first line of a file, without a fork.
line() {
  text=
  [ -r "$1" ] && IFS= read -r text <"$1"
} 2>/dev/null
tell_line() {
  line "$2"
  tell "$1" "$text"
}

# ---- what may change from run to run

read -r load rest </proc/loadavg 2>/dev/null
tell load_average "$load"
read -r uptime rest </proc/uptime 2>/dev/null
tell uptime_s "$uptime"
while read -r key value rest; do
  case $key in
    MemTotal:) tell memory_total_kib "$value" ;;
    MemAvailable:) tell memory_available_kib "$value" ;;
  esac
done </proc/meminfo 2>/dev/null

tell_line clock_source /sys/devices/system/clocksource/clocksource0/current_clocksource

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
tell governor "$governors"
tell frequency_now_min_khz "$now_min"
tell frequency_now_max_khz "$now_max"
tell_line frequency_min_khz /sys/devices/system/cpu/cpu0/cpufreq/scaling_min_freq
tell_line frequency_max_khz /sys/devices/system/cpu/cpu0/cpufreq/scaling_max_freq
tell_line frequency_hardware_max_khz /sys/devices/system/cpu/cpu0/cpufreq/cpuinfo_max_freq

# The hottest of the zones.
hottest=
for zone in /sys/class/thermal/thermal_zone*; do
  line "$zone/temp"
  [ -z "$text" ] || [ "$text" -le "${hottest:--1000000}" ] 2>/dev/null || hottest=$text
done
tell temperature_mc "$hottest"

# How often the cores were slowed down for heat since the start (x86).
count=
for core in /sys/devices/system/cpu/cpu[0-9]*/thermal_throttle; do
  line "$core/core_throttle_count"
  [ -z "$text" ] || count=$((${count:-0} + text))
done
tell throttle_count "$count"

# A Raspberry Pi's own word on its voltage and heat.
if command -v vcgencmd >/dev/null 2>&1; then
  throttled=$(vcgencmd get_throttled 2>/dev/null)
  case $throttled in throttled=*) tell throttled "${throttled#throttled=}" ;; esac
fi
[ "$depth" = full ] || exit 0

# ---- what the machine is

tell architecture "$(uname -m)"
tell kernel "$(uname -sr)"
while IFS='=' read -r key value; do
  [ "$key" = PRETTY_NAME ] && value=${value#\"} && tell system "${value%\"}"
done </etc/os-release 2>/dev/null
model=
while IFS=':' read -r key value; do
  case $key in
    "model name"* | "Model"*) model=${value# } ;;
  esac
done </proc/cpuinfo 2>/dev/null
tell cpu_model "$model"
cores=0
for core in /sys/devices/system/cpu/cpu[0-9]*; do
  [ -d "$core" ] && cores=$((cores + 1))
done
tell cores "$cores"
tell online_cores "$(grep -c '^processor' /proc/cpuinfo 2>/dev/null)"

for program in tether-sut tether-exec; do
  if command -v "$program" >/dev/null 2>&1; then
    said=$("$program" --version 2>&1 </dev/null | head -n 1)
    tell "version_$program" "${said:-says nothing}"
  else
    tell "version_$program" none
  fi
done

# What tether-exec may stop a program with: a cgroup v2 below its own, else signals.
freezer=signals
while read -r device folder type rest; do
  [ "$type" = cgroup2 ] || continue
  while IFS=: read -r number names path; do
    [ "$number" = 0 ] && [ -w "$folder$path/cgroup.procs" ] && freezer=cgroup
  done </proc/self/cgroup
  break
done </proc/mounts 2>/dev/null
tell freezer "$freezer"

if [ -r "${TETHER_BOARD_LOCK:-/tmp/tether-board.lock}" ]; then
  {
    read -r pid rest
    IFS= read -r name
  } <"${TETHER_BOARD_LOCK:-/tmp/tether-board.lock}"
  [ -d "/proc/$pid" ] && tell held_by "$name"
fi

# Whoever takes a twentieth of a core or more, over a second; not what asks.
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
tell busy "${busy:-none}"

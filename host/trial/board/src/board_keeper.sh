# Reserves a board for one run of Tether. Needs only a POSIX sh, such as busybox; sent over SSH.
#
# Variable: who, a line that describes the run. Standard input: an empty line every second; "stop" ends the
# SUTs. When the input ends, or has been silent for some seconds, all processes and files of the run are removed.
# Prints one of: "held HOST FOLDER" (the host as seen from here), "busy WHO (pid N on the board)", "failed WHY"; and "stopped".
set -u
umask 077
PATH=$PATH:/usr/local/sbin:/usr/sbin:/sbin
lock=${TETHER_BOARD_LOCK:-/tmp/tether-board.lock}
boot=$(cat /proc/sys/kernel/random/boot_id 2>/dev/null)
folder=

give_up() {
  [ -z "$folder" ] || rm -rf "$folder"
  rm -f "$lock.$$"
  printf '%s\n' "$*"
  exit 1
}

# When the process started, to distinguish it from a later one with the same number.
started() { sed 's/^.*) //' "/proc/$1/stat" 2>/dev/null | cut -d ' ' -f 20; }

# Whether the run that wrote the lock file still exists; sets pid and name.
lives() {
  pid= start= its_boot= name=
  { read -r pid start its_boot; IFS= read -r name; } <"$1" 2>/dev/null
  [ -n "$start" ] && [ "$its_boot" = "$boot" ] && [ "$(started "$pid")" = "$start" ]
}

# The lock file appears complete or not at all. A lock that was moved away is checked again, because
# another run may have taken it in between.
take_lock() {
  printf '%s\n%s\n' "$$ $(started $$) $boot" "$who" >"$lock.$$" 2>/dev/null ||
    give_up "failed cannot write $lock.$$ on the board"
  chmod 644 "$lock.$$"
  for attempt in 1 2 3 4 5; do
    if ln "$lock.$$" "$lock" 2>/dev/null; then
      rm -f "$lock.$$"
      return
    fi
    lives "$lock" && give_up "busy $name (pid $pid on the board)"
    mv "$lock" "$lock.$$.dead" 2>/dev/null || continue
    lives "$lock.$$.dead" && ln "$lock.$$.dead" "$lock" 2>/dev/null
    rm -f "$lock.$$.dead"
  done
  give_up "failed cannot take $lock on the board; remove it if no run is active"
}

# Processes of the run: the groups of SUTs, and processes with the run's folder in their environment.
of_the_run() {
  for file in "$folder"/pid.*; do
    [ -e "$file" ] && read -r group <"$file" && kill -0 "-$group" 2>/dev/null && echo "-$group"
  done
  grep -l "TETHER_OUT=$folder/" /proc/[0-9]*/environ 2>/dev/null | cut -d / -f 3
}

end_suts() {
  for signal in TERM KILL; do
    running=$(of_the_run)
    for process in $running; do
      kill "-$signal" "$process" 2>/dev/null
      kill -CONT "$process" 2>/dev/null
    done
    for attempt in 1 2 3 4 5 6 7 8 9 10; do
      [ -n "$running" ] || return 0
      sleep 0.1 2>/dev/null || sleep 1
      running=$(of_the_run)
    done
  done
}

end_run() {
  end_suts
  lives "$lock" && [ "$pid" = "$$" ] && rm -f "$lock"
  rm -rf "$folder"
}

# Ends the run if the host is silent.
watch() {
  missed=0
  while [ "$missed" -lt 5 ] && sleep 2; do
    if [ -e "$folder/beat" ]; then
      rm -f "$folder/beat"
      missed=0
    else
      missed=$((missed + 1))
    fi
    [ -d "$folder" ] || exit
  done
  end_run
  kill -KILL $$
}

take_lock
folder=$(mktemp -d "${TMPDIR:-/tmp}/tether.XXXXXX") || give_up "failed no temporary folder on the board"
trap 'end_run; exit 1' HUP INT TERM PIPE
watch </dev/null >/dev/null 2>&1 &
watcher=$!
printf 'held %s %s\n' "${SSH_CONNECTION%% *}" "$folder"
while IFS= read -r word; do
  : >"$folder/beat"
  [ "$word" = stop ] && end_suts && echo stopped
done
trap '' HUP INT TERM PIPE
end_run
kill "$watcher" 2>/dev/null
exit 0

# Runs one SUT on a board. Needs only a POSIX sh, such as busybox; sent over SSH.
#
# Variables: folder (of the run), uav, program, supervisor (tether-exec; empty: none is needed),
# launcher (of the target; may be empty). Functions: join exports the environment of the SUT, and run_sut
# starts "$program" in a new session. Exit code: that of the SUT, or 128 + the signal that ended it; 120
# after a line "tether: REASON" if it could not be started.
set -u

fail() {
  printf 'tether: %s\n' "$*"
  exit 120
}

# The path of the program. If it does not exist on this board, its name is searched for in PATH.
found() {
  if [ -f "$1" ] && [ "${1#*/}" != "$1" ]; then
    printf '%s\n' "$1"
    return
  fi
  name=${1##*/}
  IFS=:
  for place in $PATH; do
    if [ -f "$place/$name" ] && [ -x "$place/$name" ]; then
      printf '%s\n' "$place/$name"
      return
    fi
  done
  return 1
}

# Class, byte order and machine of an ELF file; nothing for other files.
machine() {
  bytes=$(dd if="$1" bs=20 count=1 2>/dev/null | od -A n -t x1 | tr -d ' \n')
  case $bytes in 7f454c46*) printf '%s\n' "$bytes" | cut -c 9-12,37-40 ;; esac
}

machine_name() {
  case $1 in
    02013e00) echo x86-64 ;;
    0201b700) echo AArch64 ;;
    01012800) echo "32-bit ARM" ;;
    01010300) echo "32-bit x86" ;;
    0201f300) echo RISC-V ;;
    *) echo "another machine ($1)" ;;
  esac
}

# A shell would run a program for another machine as a script.
require_machine() {
  its=$(machine "$1")
  ours=$(machine "/proc/$$/exe")
  [ -n "$its" ] && [ -n "$ours" ] && [ "$its" != "$ours" ] || return 0
  case $ours$its in 02013e0001010300 | 0201b70001012800) return 0 ;; esac
  for handler in /proc/sys/fs/binfmt_misc/qemu-*; do [ -e "$handler" ] && return 0; done
  fail "wrong architecture: $1 is built for $(machine_name "$its"), the board is $(machine_name "$ours")"
}

command -v setsid >/dev/null || fail "the board has no program \"setsid\" (Debian: util-linux)"
[ -d "$folder" ] || fail "the board is no longer reserved for this run"
wanted=$program
program=$(found "$wanted") ||
  fail "the board has no program \"$wanted\" (nor ${wanted##*/} in PATH=$PATH). Install it there, or set program_folder in a target file"
[ -x "$program" ] || fail "$program is not executable; on the board, type: chmod +x $program"
[ -z "$supervisor" ] || command -v "$supervisor" >/dev/null ||
  fail "the board has no program \"$supervisor\", which concurrent SUTs and several SUTs on one board need (PATH=$PATH). Install the package tether-sut there"
if [ -z "$launcher" ]; then
  require_machine "$program"
else
  command -v "$launcher" >/dev/null || fail "the board has no program \"$launcher\", the launcher of the target"
fi

join
mkdir "$folder/out.$uav" || fail "cannot make $folder/out.$uav"
# The shell's messages about the end of the SUT must not be in its output.
exec 3>&2 2>/dev/null
cd "$folder" || fail "cannot enter $folder"
TETHER_OUT=$folder/out.$uav
export TETHER_OUT
run_sut </dev/null 2>&3
code=$?
# Its remaining children would keep the connection open.
read -r group <"$folder/pid.$uav" && kill -KILL "-$group"
exit "$code"

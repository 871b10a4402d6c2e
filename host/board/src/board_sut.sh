# Runs one SUT on a board. POSIX sh, busybox will do; sent over SSH, nothing is installed.
#
# Given: folder (of the run), uav, program, supervisor (tether-exec, for a concurrent SUT; else empty),
# launcher (the target's; may be empty); the functions join, which exports the SUT's environment, and
# run_sut, which starts "$program" in a session of its own. Exits as the SUT does: with its code, or with 128 + the signal that ended it; with 120
# and a line "tether: WHY" where it could not be started.
set -u

fail() {
  printf 'tether: %s\n' "$*"
  exit 120
}

# Where the program is: a path as it is; where that is none of this board's, its name in PATH.
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

# Class, byte order and machine of an ELF file; nothing of other files.
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

# A shell would take another machine's program for a script of its own and run it word by word.
require_machine() {
  its=$(machine "$1")
  ours=$(machine "/proc/$$/exe")
  [ -n "$its" ] && [ -n "$ours" ] && [ "$its" != "$ours" ] || return 0
  case $ours$its in 02013e0001010300 | 0201b70001012800) return 0 ;; esac
  for handler in /proc/sys/fs/binfmt_misc/qemu-*; do [ -e "$handler" ] && return 0; done
  fail "wrong architecture: $1 is built for $(machine_name "$its"), the board is $(machine_name "$ours")"
}

command -v setsid >/dev/null || fail "the board has no program \"setsid\" (Debian: util-linux)"
[ -d "$folder" ] || fail "the board is no longer held for this run"
wanted=$program
program=$(found "$wanted") ||
  fail "the board has no program \"$wanted\" (nor ${wanted##*/} in PATH=$PATH); install it there, or name its folder as program_folder in a target file"
[ -x "$program" ] || fail "$program may not be executed; on the board: chmod +x $program"
[ -z "$supervisor" ] || command -v "$supervisor" >/dev/null ||
  fail "the board has no program \"$supervisor\", under which a concurrent SUT runs (PATH=$PATH); install it there: it is in the package tether-sut"
if [ -z "$launcher" ]; then
  require_machine "$program"
else
  command -v "$launcher" >/dev/null || fail "the board has no program \"$launcher\", which the target names as launcher"
fi

join
mkdir "$folder/out.$uav" || fail "cannot make $folder/out.$uav"
# The shell's own remarks on how the SUT ended are none of the SUT's.
exec 3>&2 2>/dev/null
cd "$folder" || fail "cannot enter $folder"
TETHER_OUT=$folder/out.$uav
export TETHER_OUT
run_sut </dev/null 2>&3
code=$?
# Children that it left would keep the connection open.
read -r group <"$folder/pid.$uav" && kill -KILL "-$group"
exit "$code"

#!/bin/sh
# check_pymavlink.sh EXCHANGE FOLDER: messages of every type that pymavlink knows, from Tether (the program EXCHANGE) to
# pymavlink and back, plain and signed. Files are in FOLDER, among them Debian sid's python3-pymavlink, which Debian 12
# does not have: it is unpacked there, and nothing is installed.
# Exit 77 (ctest: skipped) where it cannot be had.
set -eu
exchange=$1
folder=$2
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$folder/lists/partial" "$folder/cache/archives/partial"
cd "$folder"

if [ ! -d root ]; then
  echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian sid main" >sources.list
  set -- -o Dir::Etc::sourcelist="$PWD/sources.list" -o Dir::Etc::sourceparts=- -o Dir::State::lists="$PWD/lists" \
    -o Dir::Cache="$PWD/cache" -o APT::Sandbox::User=root
  apt-get "$@" update >apt.log 2>&1 && apt-get "$@" download python3-pymavlink >>apt.log 2>&1 ||
    { echo "skipped: Debian sid cannot be reached"; exit 77; }
  dpkg -x python3-pymavlink_*.deb root
fi
export PYTHONPATH="$PWD/root/usr/lib/python3/dist-packages" PYTHONDONTWRITEBYTECODE=1
peer() { /usr/bin/python3 "$here/peer.py" "$@"; }

# same WHAT EXPECTED FOUND
same() {
  peer known "$2" >expected.txt
  peer known "$3" >found.txt
  cmp -s expected.txt found.txt || { echo "$1: not the same"; diff expected.txt found.txt | cut -c 1-2000 | head -n 6; exit 1; }
}

for passphrase in "" "a secret"; do
  set -- ${passphrase:+"$passphrase"}
  "$exchange" write ours.bin "$@" >ours.txt
  peer read ours.bin "$@" >ours_seen.txt
  same "from Tether" ours.txt ours_seen.txt

  cut -d ' ' -f 2 ours.txt | sort -u >names.txt
  peer write theirs.bin names.txt "$@" >theirs.txt
  "$exchange" read theirs.bin "$@" >theirs_seen.txt
  same "to Tether" theirs.txt theirs_seen.txt
  types=$(cut -d ' ' -f 2 theirs.txt | sort -u | wc -l)
  [ "$types" -ge 80 ] || { echo "only $types types of messages"; exit 1; }
done

# It can fail: with another key, neither side takes a frame of the other.
if peer read ours.bin "another secret" >other.txt 2>&1; then echo "pymavlink took a wrong signature"; exit 1; fi
if "$exchange" read theirs.bin "another secret" >other.txt || [ -s other.txt ]; then echo "Tether took a wrong signature"; exit 1; fi

echo "$(wc -l <found.txt) messages of $types types each way, plain and signed"

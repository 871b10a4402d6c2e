#!/bin/sh
# check_mavlink.sh EXCHANGE TETHER EXAMPLE FOLDER: messages of every type, from Tether (the program EXCHANGE) to
# node-mavlink and back, plain and signed. Then the example of a companion in Node flies. Files are in FOLDER.
# Exit 77 (ctest: skipped) where there is no node or npm, or the package cannot be fetched.
set -eu
exchange=$1
tether=$2
example=$3
folder=$4
here=$(cd "$(dirname "$0")" && pwd)

command -v node >/dev/null && command -v npm >/dev/null || { echo "skipped: install nodejs and npm"; exit 77; }
# In a folder of its own: the source tree stays as it is.
mkdir -p "$folder"
cp "$here"/package.json "$here"/package-lock.json "$here"/.npmrc "$here"/*.mjs "$folder"
cd "$folder"
[ -d node_modules/node-mavlink ] || npm ci --silent || { echo "skipped: npm cannot fetch node-mavlink"; exit 77; }

# same WHAT EXPECTED FOUND
same() {
  cmp -s "$2" "$3" || { echo "$1: not the same"; diff "$2" "$3" | cut -c 1-2000 | head -n 6; exit 1; }
}

# The message that node-mavlink 2.3.0 does not know: in MAVLink's definitions it is work in progress.
unknown=ESC_STATUS
for passphrase in "" "a secret"; do
  set -- ${passphrase:+"$passphrase"}

  "$exchange" write ours.bin "$@" >ours.txt
  cut -d ' ' -f 2 ours.txt | sort -u >names.txt
  [ "$(wc -l <names.txt)" -ge 80 ] || { echo "only $(wc -l <names.txt) types of messages"; exit 1; }
  node peer.mjs read ours.bin "$@" >ours_seen.txt
  grep -v "^[0-9]* $unknown " ours.txt >ours_known.txt
  same "from Tether" ours_known.txt ours_seen.txt

  node peer.mjs write theirs.bin names.txt "$@" >theirs.txt
  "$exchange" read theirs.bin "$@" >theirs_seen.txt
  same "to Tether" theirs.txt theirs_seen.txt
  [ "$(cut -d ' ' -f 2 theirs.txt | sort -u | wc -l)" -eq $(($(wc -l <names.txt) - 1)) ] || { echo "types are missing"; exit 1; }
done

# It can fail: with another key, neither side takes a frame of the other.
if node peer.mjs read ours.bin "another secret" >other.txt; then echo "node-mavlink took a wrong signature"; exit 1; fi
if "$exchange" read theirs.bin "another secret" >other.txt || [ -s other.txt ]; then echo "Tether took a wrong signature"; exit 1; fi
cp "$example"/mission.* .
# Threads of Node may compute in parallel or wait for each other on a busy machine: then there is no answer (3).
"$tether" run mission.toml --quiet --force --out flight || [ $? -eq 3 ] || { cat flight/sut-uav1.log; exit 1; }
grep -q "landed after" flight/sut-uav1.log || { cat flight/sut-uav1.log; echo "the example does not fly"; exit 1; }

echo "$(wc -l <ours_seen.txt) messages of $(cut -d ' ' -f 2 ours_seen.txt | sort -u | wc -l) types each way, plain and signed"

#!/bin/sh
# check_mcap.sh WRITER FOLDER: writes sample records with WRITER into FOLDER and reads them with MCAP's own reader.
# Exit 77 (ctest: skipped) where there is no node or npm, or the reader cannot be fetched.
set -eu
writer=$1
folder=$2
here=$(cd "$(dirname "$0")" && pwd)

command -v node >/dev/null && command -v npm >/dev/null || { echo "skipped: install nodejs and npm"; exit 77; }
# In a folder of its own: the source tree stays as it is.
mkdir -p "$folder"
cp "$here"/package.json "$here"/package-lock.json "$here"/.npmrc "$here"/*.mjs "$folder"
cd "$folder"
[ -d node_modules/@mcap/core ] || npm ci --silent || { echo "skipped: npm cannot fetch @mcap/core"; exit 77; }

"$writer" whole.mcap
node read_mcap.mjs whole.mcap >whole.json || { cat whole.json; exit 1; }
"$writer" torn.mcap --torn
node read_mcap.mjs --partial torn.mcap >torn.json || { cat torn.json; exit 1; }

# The reader can fail: a torn file is not whole, and a flipped bit is noticed.
if node read_mcap.mjs torn.mcap >torn_as_whole.json; then
  echo "a torn record was taken for a whole one"; exit 1
fi
node -e '
  const fs = require("fs");
  const bytes = fs.readFileSync("whole.mcap");
  bytes[bytes.length >> 1] ^= 1;
  fs.writeFileSync("flipped.mcap", bytes);'
if node read_mcap.mjs flipped.mcap >flipped.json; then
  echo "a damaged record was taken for a sound one"; exit 1
fi

node -e '
  const assert = require("assert");
  const whole = require("./whole.json");
  const torn = require("./torn.json");
  const counts = { "/commands/uav": 30, "/ground_truth/uav": 300, "/images/uav/camera": 30, "/interactions": 300, "/task/uav": 30, "/tf": 300 };
  for (const summary of [whole, torn]) {
    const messages = Object.fromEntries(Object.entries(summary.topics).map(([name, t]) => [name, t.messages]).sort());
    assert.deepStrictEqual(messages, counts);
    assert.strictEqual(summary.topics["/images/uav/camera"].schema, "foxglove.CompressedImage");
    assert.strictEqual(summary.metadata.tether.scenario, "sample");
  }
  assert.strictEqual(whole.metadata["tether.end"].interactions, "300");
  assert.ok(whole.complete && !torn.complete && whole.chunks >= 3);'
echo "both records read as they should"

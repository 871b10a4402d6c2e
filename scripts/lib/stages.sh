# Stages of scripts/test, and the table that it ends with; sourced, never run.
# shellcheck shell=bash

stage_names=()
stage_seconds=()
began=$SECONDS
declare -A beside_pids=()
# Of the system tests; see scripts/test.
failed_beside_others=

# begin_stages: forgets the results of an earlier run, and has the summary printed at the end of this one.
begin_stages() {
  rm -rf "$ROOT"/build/{ci,asan,tsan}/test-results
  trap summary EXIT
}

# stage NAME COMMAND...: runs it, and remembers how long it took.
stage() {
  local since=$SECONDS
  say "$1"
  stage_names+=("$1")
  "${@:2}"
  stage_seconds+=("$((SECONDS - since))")
}

# beside NAME COMMAND...: starts a download, or a build that takes what the stages leave of the cores. It runs beside the
# stages that follow, in a process group of its own, until one of them awaits it.
beside() {
  mkdir -p "$ROOT/build"
  setsid nice -n 19 "${@:2}" >"$ROOT/build/$1.log" 2>&1 &
  beside_pids[$1]=$!
}

# await NAME: prints what that command printed, and fails if it failed. Once awaited, it does nothing.
await() {
  local pid="${beside_pids[$1]:-}" status=0
  [ -n "$pid" ] || return 0
  wait "$pid" || status=$?
  unset "beside_pids[$1]"
  cat "$ROOT/build/$1.log"
  return "$status"
}

# Cases of all test programs so far: "seconds<TAB>result<TAB>build: program.Suite.Case<TAB>why" a line.
cases() {
  local file
  for file in "$ROOT"/build/{ci,asan,tsan}/test-results/*.xml; do
    [ -e "$file" ] || continue
    awk -v build="$(basename "$(dirname "$(dirname "$file")")")" -v program="$(basename "$file" .xml)" '
      function value(name) { return match($0, " " name "=\"[^\"]*\"") ? substr($0, RSTART + length(name) + 3, RLENGTH - length(name) - 4) : "" }
      function put() { if (id != "") printf "%s\t%s\t%s\t%s\n", seconds, result, id, why; id = "" }
      /<testcase / {
        put()
        if (value("status") != "run") next
        id = build ": " program " " value("classname") "." value("name"); seconds = value("time")
        result = value("result") == "skipped" ? "skipped" : "passed"; why = ""
      }
      /<failure / { result = "failed" }
      /<skipped / { sub(/.*&#x0A;/, "", $0); why = value("message"); if (why == "") { why = $0; sub(/".*/, "", why) } }
      END { put() }' "$file"
  done
}

# The last words of scripts/test, whatever it ended with.
summary() {
  local status=$? i
  for i in "${beside_pids[@]}"; do kill -- "-$i" 2>/dev/null || true; done
  printf '\n\033[1m== Seconds of each stage\033[0m\n'
  for i in "${!stage_names[@]}"; do
    printf '%6s  %s\n' "${stage_seconds[$i]:-failed}" "${stage_names[$i]}"
  done
  printf '%6s  in all\n' "$((SECONDS - began))"
  cases >"$ROOT/build/test-cases.tsv"
  printf '\n\033[1m== Seconds of the twenty slowest cases\033[0m\n'
  sort -rn "$ROOT/build/test-cases.tsv" | awk -F '\t' 'NR <= 20 { printf "%6.1f  %s\n", $1, $3 }'
  if grep -q $'\tskipped\t' "$ROOT/build/test-cases.tsv"; then
    printf '\n\033[1m== Skipped\033[0m\n'
    awk -F '\t' '$2 == "skipped" { print $3 ": " $4 }' "$ROOT/build/test-cases.tsv"
  fi
  [ -z "$failed_beside_others" ] || printf '\n\033[1m== Failed beside other tests, and ran once more\033[0m\n%s\n' "$failed_beside_others"
  echo
  awk -F '\t' '{ ++n[$2] } END { printf "%d passed, %d failed, %d skipped\n", n["passed"], n["failed"], n["skipped"] }' \
    "$ROOT/build/test-cases.tsv"
  return "$status"
}

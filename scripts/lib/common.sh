# Shared by the scripts beside this folder; sourced, never run.
# shellcheck shell=bash

set -euo pipefail

ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
JOBS="${JOBS:-$(nproc)}"

say() { printf '\n\033[1m== %s\033[0m\n' "$*"; }
fail() { printf '%s: %s\n' "$(basename "$0")" "$*" >&2; exit 1; }

# Prints the lines of the calling script's own leading comment, without the marks, up to what is meant
# for shellcheck.
usage() { sed -n '2,/^[^#]/{/^# shellcheck /q;/^#/s/^# \{0,1\}//p}' "$0"; }

# ---- packages ------------------------------------------------------------------------------------
# Debian 12's names, by what they are for.

# Compiler and libraries of the product.
packages_build=(
  g++ cmake ninja-build mold
  libmujoco-dev libhwy-dev
  libsdformat-dev libtinyxml2-dev libconsole-bridge-dev libassimp-dev
  libopencv-dev libpng-dev libturbojpeg0-dev zlib1g-dev libzstd-dev libboost-dev
  libflatbuffers-dev flatbuffers-compiler
  libfmt-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev
  gnuplot-nox
)
# The emulator whose instructions are counted.
packages_demo=(qemu-user)
packages_test=(git python3 cloc libgtest-dev libgmock-dev libbenchmark-dev clang-format qemu-user)
# The library as a user builds against it, and the manual pages.
packages_test+=(make pkgconf mandoc)
# What a program as it is reads its camera by (data/programs/mavlink_face_anchor.py).
packages_test+=(python3-opencv)
# The example of a driver for ROS 2, and its other side.
packages_test+=(cyclonedds-dev cyclonedds-tools libfastrtps-dev)
# The package for Python: what its programs and records need, and the checker of its types.
packages_test+=(python3-numpy python3-zstandard mypy)
# What notebooks use besides; large, and for `scripts/test --full` only.
packages_notebook=(python3-matplotlib python3-pandas)
# The schema of JUnit files.
packages_test+=(libxml2-utils)
# Boards in the tests: this machine, over SSH.
packages_test+=(openssh-server openssh-client)
# A cluster in the tests: this machine as two nodes.
packages_test+=(slurm-wlm munge parallel)
# Debian packages of our own, for this machine.
packages_pack=(dpkg-dev file gzip)
# The target's programs for 64-bit ARM, and what runs them here.
packages_arm64=(cmake ninja-build flatbuffers-compiler g++-aarch64-linux-gnu mmdebstrap qemu-user "${packages_pack[@]}")
# Gazebo's plugin against Debian 11's packages, and the screen that Gazebo's cameras need.
packages_gazebo=(cmake ninja-build g++ pkgconf mmdebstrap xvfb xauth)
# mmdebstrap as anyone but root.
[ "$(id -u)" -eq 0 ] || { packages_arm64+=(uidmap); packages_gazebo+=(uidmap); }
# libFuzzer and the sanitizers of clang; llvm has what names functions in their reports.
packages_fuzz=(clang-14 libclang-rt-14-dev llvm-14)
packages_tidy=(git clang-tidy)
packages_coverage=(gcovr)
# The site of documents.
packages_docs=(doxygen)

# True where a package is installed. A name may be satisfied by another package that provides it.
is_installed() { dpkg-query -W -f='${Status}\n' "$1" 2>/dev/null | grep -q '^install ok installed$'; }

# Runs a command as root, or says what to type.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    fail "not root and no sudo here. As root, type:
  apt-get update && apt-get install --no-install-recommends ${missing[*]}"
  fi
}

# install_packages NAME...: installs with apt those of the packages that are missing; silent when none is.
install_packages() {
  local name
  missing=()
  for name in "$@"; do is_installed "$name" || missing+=("$name"); done
  [ "${#missing[@]}" -gt 0 ] || return 0
  command -v apt-get >/dev/null ||
    fail "no apt-get here. Tether is built on Debian 12; install the equivalents of: ${missing[*]}"
  say "Installing ${#missing[@]} Debian package(s): ${missing[*]}"
  as_root apt-get update -q
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
}

# The independent peers for records and MAVLink (tests/system/packages) run on Node.js, 18 or later, whoever packaged it.
command -v node >/dev/null || packages_test+=(nodejs)
command -v npm >/dev/null || packages_test+=(npm)

# install_for PURPOSE...: build, demo, test, fuzz, tidy, coverage, package, arm64, gazebo, docs or notebook
install_for() {
  local purpose names=()
  for purpose in "$@"; do
    case "$purpose" in
      build) names+=("${packages_build[@]}") ;;
      demo) names+=("${packages_build[@]}" "${packages_demo[@]}") ;;
      test) names+=("${packages_build[@]}" "${packages_test[@]}") ;;
      fuzz) names+=("${packages_build[@]}" "${packages_test[@]}" "${packages_fuzz[@]}") ;;
      tidy) names+=("${packages_build[@]}" "${packages_test[@]}" "${packages_tidy[@]}") ;;
      coverage) names+=("${packages_build[@]}" "${packages_test[@]}" "${packages_coverage[@]}") ;;
      package) names+=("${packages_build[@]}" "${packages_pack[@]}") ;;
      arm64) names+=("${packages_arm64[@]}") ;;
      gazebo) names+=("${packages_gazebo[@]}") ;;
      docs) names+=("${packages_docs[@]}") ;;
      notebook) names+=("${packages_notebook[@]}") ;;
      *) fail "'$purpose': build, demo, test, fuzz, tidy, coverage, package, arm64, gazebo, docs or notebook" ;;
    esac
  done
  mapfile -t names < <(printf '%s\n' "${names[@]}" | sort -u)
  install_packages "${names[@]}"
}

# ---- building ------------------------------------------------------------------------------------

# The address space that a sanitizer expects is not what every kernel's randomisation leaves it.
without_aslr() {
  if setarch "$(uname -m)" -R true 2>/dev/null; then
    setarch "$(uname -m)" -R "$@"
  else
    "$@"
  fi
}

# build PRESET [TARGET...]: configures (cheap when nothing changed) and builds.
build() {
  local preset="$1"
  shift
  (
    cd "$ROOT"
    cmake --preset "$preset" --log-level=WARNING
    without_aslr cmake --build --preset "$preset" --parallel "$JOBS" ${1:+--target "$@"}
  )
}

# pack PRESET ARCHITECTURE: packs what the preset has built, for that architecture of Debian, into
# build/PRESET/packages.
pack() {
  local folder="$ROOT/build/$1"
  rm -rf "$folder/packages"
  (cd "$folder" && DEB_HOST_ARCH="$2" cpack -G DEB >cpack.log 2>&1) || fail "packing failed; see $folder/cpack.log"
  rm -rf "$folder/packages/_CPack_Packages"
  ls "$folder"/packages/*.deb
}

# Files that clang-format and clang-tidy look at: tracked and new ones, or all where this is no git checkout.
source_files() {
  cd "$ROOT"
  if git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
    git ls-files --cached --others --exclude-standard -- "$@" | sort -u | while read -r file; do
      [ ! -e "$file" ] || echo "$file"
    done
  else
    find apps bench common host target tests -type f \( -name '*.h' -o -name '*.hpp' -o -name '*.cpp' \) | sort
  fi
}

# The steps that `deploy/up` and `tests/run` have in common: install what is missing, build, build the viewer. Sourced by
# both; expects `root` (the checkout) and `install` (yes or no), and `set -euo pipefail`.

logs="$root/build/logs"
mkdir -p "$logs"

say() { printf 'talus: %s\n' "$*"; }
fail() {
  printf 'talus: error: %s\n' "$*" >&2
  exit 1
}

# step LABEL LOG COMMAND...: runs the command with its output in build/logs/LOG. The command stays in the foreground so
# that Ctrl-C reaches it; beside it a line shows how far it is (a terminal) or that it lives (anything else).
step() {
  local label=$1 log="$logs/$2" code=0 began=$SECONDS beat
  shift 2
  : >"$log"
  say "$label ..."
  beat_along "$label" "$log" &
  beat=$!
  "$@" >"$log" 2>&1 </dev/null || code=$?
  kill "$beat" 2>/dev/null || true
  wait "$beat" 2>/dev/null || true
  [ ! -t 1 ] || printf '\r\033[K'
  if [ "$code" -ne 0 ]; then
    printf -- '--- the end of %s\n' "${log#"$root"/}" >&2
    tail -n 40 "$log" >&2
    printf -- '---\n' >&2
    say "$label: failed with code $code after $((SECONDS - began)) s; all of its output is in ${log#"$root"/}" >&2
    return "$code"
  fi
  say "$label: done in $((SECONDS - began)) s"
}

beat_along() {
  local label=$1 log=$2 began=$SECONDS every=30 quiet
  trap 'exit 0' TERM
  [ ! -t 1 ] || every=1
  exec {quiet}<> <(:)  # never written to: a sleep that leaves no process behind
  while true; do
    read -rt "$every" -u "$quiet" || true
    kill -0 $$ 2>/dev/null || exit 0 # ended by a signal
    local last
    last=$(tail -c 400 "$log" 2>/dev/null | tr '\r' '\n' | grep -v '^[[:space:]]*$' | tail -n 1 | cut -c 1-90) || last=
    if [ -t 1 ]; then
      printf '\r\033[K  %s s  %s' "$((SECONDS - began))" "$last"
    else
      say "  $label: $((SECONDS - began)) s, $last"
    fi
  done
}

# Compilers that run at once: one a processor, but no more than memory holds at 1.2 GB each.
jobs_at_once() {
  local processors memory_kb fit
  processors=$(nproc)
  memory_kb=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo)
  fit=$((memory_kb / 1200000))
  [ "$fit" -ge 1 ] || fit=1
  echo $((processors < fit ? processors : fit))
}

packages_of() {
  local section
  for section in "$@"; do
    awk -v want="[$section]" '/^#/ || NF == 0 { next } /^\[/ { on = ($1 == want); next } on { print $1 }' \
      "$root/deploy/packages"
  done
}

node_is_there() {
  command -v node >/dev/null && command -v npm >/dev/null &&
    [ "$(node -p 'process.versions.node.split(".")[0]')" -ge 18 ]
}

# install_packages SECTION...: quick and without network when nothing is missing.
install_packages() {
  [ "$install" = yes ] || return 0
  command -v dpkg-query >/dev/null ||
    fail "this is not Debian. Install what deploy/packages lists and run again with --no-install."
  local wanted present missing=() package as_root=()
  mapfile -t wanted < <(packages_of "$@")
  present=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' 2>/dev/null | awk '$2 == "installed" { print $1 }')
  for package in "${wanted[@]}"; do
    case $package in nodejs | npm) ! node_is_there || continue ;; esac
    grep -qxF -- "$package" <<<"$present" || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      fail "packages are missing, and this is neither root nor is there sudo. As root: apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
    sudo -v || fail "sudo was refused. As root: apt-get install --no-install-recommends ${missing[*]}"
  fi
  as_root+=(env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0)
  say "missing: ${missing[*]}"
  step "apt-get update" apt-update.log "${as_root[@]}" update ||
    fail "the package lists could not be fetched. Check the network and /etc/apt/sources.list, then run again."
  step "apt-get install, ${#missing[@]} packages and what they need" apt-install.log \
    "${as_root[@]}" install -y --no-install-recommends "${missing[@]}" ||
    fail "packages could not be installed. The names are those of Debian 12 (bookworm); elsewhere install their like and run again with --no-install."
}

# unpack_packages: programs of [unpacked] that cannot be run yet, without the rest of their packages.
unpack_packages() {
  local folder="$root/build/unpacked" missing=() package
  export PATH="$PATH:/usr/sbin:$folder/usr/sbin:$folder/usr/bin"
  [ "$install" = yes ] || return 0
  for package in $(packages_of unpacked); do
    command -v "$package" >/dev/null || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  step "unpacking ${missing[*]}" unpack.log unpack_into "$folder" "${missing[@]}" ||
    fail "packages could not be fetched: apt-get download ${missing[*]}"
}

unpack_into() {
  local folder=$1 package
  shift
  mkdir -p "$folder/packages"
  (cd "$folder/packages" && rm -f ./*.deb && apt-get download "$@") || return 1
  for package in "$folder"/packages/*.deb; do dpkg-deb -x "$package" "$folder" || return 1; done
}

# build PRESET LABEL CMAKE_ARGUMENT... -- TARGET...
build() {
  local preset=$1 label=$2 arguments=()
  shift 2
  while [ $# -gt 0 ] && [ "$1" != -- ]; do
    arguments+=("$1")
    shift
  done
  shift
  command -v cmake >/dev/null || fail "cmake is not installed. Run again without --no-install."
  (cd "$root" && step "configure $label" "configure-$preset.log" cmake --preset "$preset" "${arguments[@]}") || return 1
  (cd "$root" && step "build $label" "build-$preset.log" \
    cmake --build --preset "$preset" --parallel "$(jobs_at_once)" --target "$@") || return 1
}

# node_modules FOLDER: `npm ci` when the lock file changed since the last one.
node_modules() {
  local folder=$1 stamp lock
  command -v npm >/dev/null || fail "npm is not installed. Run again without --no-install."
  stamp="$root/$folder/node_modules/.talus-lock"
  lock="$(node --version) $(sha256sum <"$root/$folder/package-lock.json")" || return 1
  [ ! -f "$stamp" ] || [ "$(cat "$stamp")" != "$lock" ] || return 0
  (cd "$root/$folder" && step "npm ci in $folder" "npm-${folder//\//-}.log" \
    npm ci --ignore-scripts --no-audit --no-fund) || return 1
  printf '%s\n' "$lock" >"$stamp"
}

# build_viewer: client_sample/web/dist, unless it was made of just these sources.
build_viewer() {
  local web=client_sample/web sources stamp="$root/build/viewer.sources"
  sources=$(cd "$root/$web" && find . \( -name node_modules -o -name dist -o -name screenshots \) -prune -o -type f -print0 |
    LC_ALL=C sort -z | xargs -0 sha256sum | sha256sum) || return 1
  if [ -f "$root/$web/dist/index.html" ] && [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$sources" ]; then return 0; fi
  node_modules "$web" || return 1
  (cd "$root/$web" && step "build the viewer" viewer.log npm run build) || return 1
  printf '%s\n' "$sources" >"$stamp"
}

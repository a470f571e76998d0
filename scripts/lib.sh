# SPDX-License-Identifier: Apache-2.0
# Functions of the scripts in this folder. Source it.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cores=$(nproc)

say() {
  if [ -t 1 ]; then printf '\033[1m==> %s\033[0m\n' "$*"; else printf '==> %s\n' "$*"; fi
}

die() {
  printf '%s: %s\n' "${0##*/}" "$*" >&2
  exit 2
}

# help_if_asked "$@": prints the comment at the top of the calling script and ends it.
help_if_asked() {
  local word
  for word in "$@"; do
    case $word in
      -h | --help)
        awk '/^# SPDX/ { next } NR > 1 && /^#/ { sub(/^# ?/, ""); print; next } NR > 1 { exit }' "$0"
        exit 0
        ;;
      --) return 0 ;;
    esac
  done
}

# install_meanwhile OPTION: starts scripts/setup OPTION, while the script goes on; wait_for_installation waits until it is done.
install_meanwhile() {
  "$root/scripts/setup" "$1" &
  installation=$!
}
wait_for_installation() {
  wait "$installation" || die "the packages of the pages could not be installed (see above): scripts/setup --pages"
}

# for_sed TEXT: prints it as it must stand in the replacement of sed's s#...#...#.
for_sed() { printf '%s' "$1" | sed 's/[&#\\]/\\&/g'; }

# need_value "$@": checks that the option $1 is followed by a value.
need_value() { [ -n "${2-}" ] || die "$1 needs a value; see --help"; }

# split_values "$@": puts the arguments into the array words, "--name=value" as two of them, up to "--".
split_values() {
  words=()
  while [ $# -gt 0 ] && [ "$1" != -- ]; do
    case $1 in
      --*=*) words+=("${1%%=*}" "${1#*=}") ;;
      *) words+=("$1") ;;
    esac
    shift
  done
  words+=("$@")
}

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Tests that check_docs finds broken links and citations.
set -euo pipefail

copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
mkdir -p "$copy/docs" "$copy/renderer"
printf '# Page\n\n## Fill\n\nSee [itself](#fill), [the other](other.md#two-words).\n' >"$copy/docs/page.md"
printf '# Other\n\n## Two words\n' >"$copy/docs/other.md"
printf '/// docs/page.md#fill, docs/other.md\n' >"$copy/renderer/good.hpp"
scripts/check_docs "$copy" >/dev/null

# must_find WORDS FILE LINE: adds the line to a copy of the file; check_docs must report it with these words.
must_find() {
  local said
  cp -r "$copy" "$copy.planted"
  printf '%s\n' "$3" >>"$copy.planted/$2"
  said=$(scripts/check_docs "$copy.planted") && { echo "not found: $3"; exit 1; }
  rm -rf "$copy.planted"
  grep -qF "$1" <<<"$said" || { printf 'reported, but not as "%s":\n%s\n' "$1" "$said"; exit 1; }
}

must_find 'docs/page.md has no heading #nowhere' renderer/good.hpp '/// docs/page.md#nowhere'
must_find 'docs/gone.md is not there' renderer/good.hpp '/// docs/gone.md'
must_find 'other.md has no heading #gone' docs/page.md '[gone](other.md#gone)'
must_find 'gone.png is not there' docs/page.md '![gone](gone.png)'
must_find 'other.md has no heading #gone' docs/page.md $'[a text over\ntwo lines](other.md#gone)'
must_find 'broken across lines' docs/page.md $'[broken](other.md#two-\nwords)'
must_find 'cites a page that is not in the repository' renderer/good.hpp '/// as METHOD says'
echo "all planted gaps were found"

#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# build.sh BUILD [TARGET ...]: builds the targets (without any: everything) in the configured folder BUILD. Where it is
# another user's, or read-only, it has to be up to date.
set -euo pipefail
folder=$1
shift

is_writable=true
for file in "$folder" "$folder"/.ninja_*; do [[ -w $file || ! -e $file ]] || is_writable=false; done
if $is_writable; then
  exec flock "$folder" cmake --build "$folder" ${1:+--target "$@"}
fi

# Only asked through another file does ninja answer without first writing its own anew.
if [[ $(ninja -C "$folder" -n -f /dev/stdin "$@" <<< 'include build.ninja') != *'no work to do'* ]]; then
  echo "build: $folder is not up to date and, as it belongs to $(stat --format %U "$folder") or is read-only, cannot" \
    "be written to; expected a build by its owner, or BUILD=<a folder of your own>" >&2
  exit 2
fi

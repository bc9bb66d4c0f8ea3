#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# fetch.sh TABLE OWN FOLDER NAME: makes FOLDER/NAME of what the rows of TABLE for NAME give (downloads.tsv says how),
# and lays over it what is in OWN/NAME: SHA256SUMS of the files that are kept of the downloads, prepare.sh, which turns
# downloads into such files where that is needed, and files of our own.
#   MIRROR=URL     fetches URL/<last part of the address> instead
#   WITHOUT=PATH   leaves out what would be below FOLDER/NAME/PATH
# What is half there is gone on with. Exit codes: 0 done; 2 usage, or FOLDER cannot be written to; 3 what came is not
# what was expected; 4 nothing came.
set -euo pipefail

fail() {
  echo "fetch: $2" >&2
  exit "$1"
}
[[ $# -eq 4 ]] || fail 2 'expected TABLE OWN FOLDER NAME'
table=$1 own=$(realpath -m "$2/$4") folder=$3 name=$4
work=$folder/.downloads/$name
target=$folder/$name

rows=$(awk -F'\t' -v name="$name" '$1 == name' "$table")
[[ -n $rows && -e $own/SHA256SUMS ]] || fail 2 "nothing is known of '$name'; expected one of$(
  cd "$2" && for known in */SHA256SUMS; do echo -n " ${known%/*}"; done)"

if [[ -n ${WITHOUT:-} ]] && ! grep -q "^[0-9a-f]*  ${WITHOUT%/}/" "$own/SHA256SUMS"; then
  fail 2 "WITHOUT=$WITHOUT is no folder of $name; expected one of$(
    grep -o '  .*/' "$own/SHA256SUMS" | sort -u | tr -s ' \n' ' '), or one around it"
fi
# Whether a path is to be left out.
without() { [[ -n ${WITHOUT:-} && $1 == "${WITHOUT%/}"/* ]]; }
# "sha256  path" of each file that is to be there.
wanted() {
  local sum path
  while read -r sum path; do without "$path" || echo "$sum  $path"; done < "$own/SHA256SUMS"
}
sum_of() { if [[ -f $1 ]]; then sha256sum < "$1" | cut -d ' ' -f 1; else echo nothing; fi; }

# The reason in words for curl's exit code.
reason() {
  case $1 in
    6 | 7 | 28 | 35 | 52) echo 'no answer; expected a network (behind a proxy: https_proxy)' ;;
    22) echo 'refused with the error above; after 404 likely its publisher moved it' ;;
    9 | 19 | 37 | 78) echo 'the address has no such file; likely its publisher moved it' ;;
    18 | 56 | 92) echo 'the connection ended before the file did; the same command goes on with it' ;;
    23) echo "cannot write; likely the disk of $folder is full" ;;
    60 | 77) echo 'the certificate of the server is not valid here; likely the clock, or ca-certificates' ;;
    *) echo "curl ends with $1" ;;
  esac
}

# Fetches an address into a file, which has its name only once it is whole.
download() {
  local url=$1 file=$2 bytes=$3 sum=$4 code=0 found
  [[ ! -e $file ]] || return 0
  local progress=(--silent --show-error)
  [[ ! -t 2 ]] || progress=(--progress-bar)
  local get=(curl --fail --location --retry 3 --connect-timeout 30 --speed-limit 1000 --speed-time 60 "${progress[@]}")
  if [[ $bytes == - || $(stat --format %s "$file.part" 2> /dev/null) != "$bytes" ]]; then
    "${get[@]}" --continue-at - --output "$file.part" "$url" || code=$?
    if [[ $code -eq 33 || $code -eq 36 ]]; then  # it cannot be gone on with
      code=0
      "${get[@]}" --output "$file.part" "$url" || code=$?
    fi
  fi
  [[ $code -eq 0 ]] || fail 4 "$url: $(reason "$code")"
  found=$(stat --format %s "$file.part")
  if [[ $bytes != - && $found -lt $bytes ]]; then
    fail 3 "$url: $found bytes came; expected $bytes; the same command goes on with them"
  fi
  if [[ $sum != - && $(sum_of "$file.part") != "$sum" ]]; then
    found="$found bytes with SHA-256 $(sum_of "$file.part")"
    rm "$file.part"
    fail 3 "$url: found $found; expected $bytes bytes with $sum; what came is removed; likely its publisher changed it"
  fi
  mv "$file.part" "$file"
}

# Moves a download to its place among the files, or unpacks a folder of it there.
unpack() {
  local file=$1 from=$2 to=$3
  mkdir -p "$work/files/$(dirname "$to.")"
  if [[ $from == - ]]; then
    cp "$file" "$work/files/$to"
  elif ! bsdtar -x -f "$file" -C "$work/files" -s "|^.*$from|$to|" "*$from?*"; then
    bsdtar -t -f "$file" &> /dev/null || rm "$file"
    fail 3 "$file: cannot be unpacked; expected a whole archive with a folder $from, and room on the disk"
  fi
  chmod -R u+rwX "$work/files"  # whatever the archive says
}

# All wanted files are right, in this folder.
is_whole() { (cd "$1" 2> /dev/null && wanted | sha256sum --check --status 2> /dev/null); }

mkdir -p "$folder/.downloads" 2> /dev/null || fail 2 "$folder cannot be written to; expected a folder of your own"
exec 9> "$work.lock"
flock --nonblock 9 || {
  echo "fetch: waiting for another command that fetches $name"
  flock 9
}
if [[ -n $(ls -A "$target" 2> /dev/null) && ! -e $target/SHA256SUMS ]]; then
  fail 2 "$target is there and was not made by this command; expected another folder, or it moved away"
fi
mkdir -p "$work"

if ! is_whole "$target"; then
  mkdir -p "$work/files"
  chmod -R u+rwX "$work/files"
  rm -r "$work/files"
  mkdir "$work/files"
  while IFS=$'\t' read -r _ url bytes sum from to licence; do
    without "${to}x" && continue
    file=$work/$(basename "$url")
    [[ -z ${MIRROR:-} ]] || url=${MIRROR%/}/$(basename "$url")
    echo "fetch: $url ($licence)"
    download "$url" "$file" "$bytes" "$sum"
    unpack "$file" "$from" "$to"
  done <<< "$rows"
  [[ ! -e $own/prepare.sh ]] || (cd "$work/files" && bash -euo pipefail "$own/prepare.sh" "$own") ||
    fail 3 "$own/prepare.sh: fails on what came, in $work/files; expected files as its comment says${WITHOUT:+; likely \
it reads what WITHOUT=$WITHOUT leaves out}"
  while read -r sum path; do
    found=$(sum_of "$work/files/$path")
    [[ $found == "$sum" ]] || fail 3 "$path of $name: found SHA-256 $found; expected $sum; $target is as it was; what \
came is in $work, and is fetched anew once that is removed; likely its publisher changed it"
  done < <(wanted)
fi

mkdir -p "$target"
install --compare -m 644 -t "$target" "$own/SHA256SUMS"
if ! is_whole "$target"; then
  while read -r _ path; do
    mkdir -p "$(dirname "$target/$path")"
    mv -f "$work/files/$path" "$target/$path"
  done < <(wanted)
fi
# Files of ours: one that is the same keeps its time, one that the user has changed stays as FILE~.
find "$own" -maxdepth 1 -type f ! -name prepare.sh -exec install --compare --backup -m 644 -t "$target" {} +
rm -rf "$work"
echo "fetch: $target is whole: $(wanted | wc -l) files fetched and checked"

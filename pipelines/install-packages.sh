#!/usr/bin/env bash
# install-packages.sh SECTION: installs what is missing of the packages in a section of packages.txt through apt, as
# root or through sudo. Says nothing when nothing is missing. Exit code 3: this system has no such package.
set -euo pipefail

list=$(dirname "$0")/packages.txt
mapfile -t wanted < <(sed -n "/^\[$1\]$/,/^\[/p" "$list" | grep '^[a-z]')
[[ ${#wanted[@]} -gt 0 ]] || { echo "setup: $list has no section [$1]" >&2; exit 2; }

if ! command -v dpkg-query > /dev/null || ! command -v apt-get > /dev/null; then
  echo "setup: no apt on this system; the packages of [$1] in $list must be there under its own names" >&2
  exit 0
fi

# dpkg-query fails when it does not know one of them, after listing the others.
known=$(dpkg-query --show --showformat '${Status} ${Package}\n' "${wanted[@]}" 2> /dev/null || true)
installed=$(sed -n 's/^install ok installed //p' <<< "$known")
mapfile -t missing < <(comm -23 <(printf '%s\n' "${wanted[@]}" | sort) <(sort <<< "$installed"))
[[ ${#missing[@]} -gt 0 ]] || exit 0

if [[ $(id -u) -eq 0 ]]; then
  as_root=()
elif command -v sudo > /dev/null; then
  as_root=(sudo)
else
  echo "setup: packages are missing, and there is neither root nor sudo. As root, run:" >&2
  echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
  exit 1
fi

echo "setup: installing with ${as_root[*]:+sudo }apt-get: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
for package in "${missing[@]}"; do
  apt-cache show "$package" &> /dev/null || { echo "setup: this system has no package $package" >&2; exit 3; }
done
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes -qq --no-install-recommends "${missing[@]}"

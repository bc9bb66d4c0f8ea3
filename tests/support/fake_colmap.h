// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "support/temporary_folder.h"

namespace soslam {

// Writes a program `colmap` into a folder that stands for COLMAP: it notes how it was called in
// "calls" and copies the folders in "models" to --output_path, or those in "models_of_faint", if it
// is there, where the name of the database says so. Features are what "printed" says; where there
// is a file "crash", it crashes.
inline void WriteFakeColmap(const std::filesystem::path& folder) {
  WriteBytes(folder / "colmap", R"sh(#!/bin/sh
here=$(dirname "$0")
echo "$@" >> "$here/calls"
case "$1" in
  -h) echo "COLMAP 3.8 -- Structure-from-Motion";;
  feature_extractor) cat "$here/printed" 2> /dev/null || echo "  Features:        1481";;
  mapper|point_triangulator)
    models=models
    case "$*" in *database_faint.db*) [ -d "$here/models_of_faint" ] && models=models_of_faint;; esac
    while [ $# -gt 1 ]; do [ "$1" = --output_path ] && output=$2; shift; done
    echo "Registering image #1 (3)"
    [ -f "$here/crash" ] && kill -SEGV $$
    [ -d "$here/$models" ] || exit 1
    cp -r "$here/$models/." "$output";;
esac
)sh");
  std::filesystem::permissions(folder / "colmap", std::filesystem::perms::owner_all);
}

}  // namespace soslam

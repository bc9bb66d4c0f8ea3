// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "dataset/json_entry.h"

namespace soslam {

// Keys of the JSON files of a dataset folder, with hints for the names that other programs use.

const KnownKeys& CameraKeys();       // of camera.json
const KnownKeys& PlaneKeys();        // of an entry of planes.json
const KnownKeys& ObjectKeys();       // of an object of objects.json
const KnownKeys& IgnoredKeys();      // of an entry of "ignored" there
const KnownKeys& ObjectsFileKeys();  // of the whole file, when it is not a list

}  // namespace soslam

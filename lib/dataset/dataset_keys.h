// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "dataset/json_entry.h"

namespace soslam {

// The keys of the JSON files of a dataset folder, and what other programs call them.

const KnownKeys& CameraKeys();       // of camera.json
const KnownKeys& PlaneKeys();        // of an entry of planes.json
const KnownKeys& ObjectKeys();       // of an object of objects.json
const KnownKeys& IgnoredKeys();      // of what is ignored there
const KnownKeys& ObjectsFileKeys();  // of the whole file, where it is no list

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "artefact/atomic_file.h"
#include "artefact/hdf5_file.h"
#include "artefact/json_file.h"
#include "image/edge_maps.h"

namespace soslam {

// Writes edges.h5 (layout: schemas/hdf5-layout.md) frame by frame; it appears with Commit(). Throws
// SettingsError when it cannot be written.
class EdgesWriter {
 public:
  EdgesWriter(const std::filesystem::path& path, const ArtefactInfo& info);
  // Each frame once; the bytes of the file depend on the order.
  void Write(int frame_id, const EdgeMaps& maps);
  void Commit();

 private:
  AtomicFile atomic_;
  Hdf5File file_;
};

// Reads edges.h5. Throws InputError when it is missing, damaged, not of kind "edges" or too new.
class EdgesReader {
 public:
  explicit EdgesReader(const std::filesystem::path& path);
  bool Has(int frame_id) const;
  // Frame ids, ascending. Throws InputError for a group whose name is no frame id.
  std::vector<int> FrameIds() const;
  // Thread-safe. Throws InputError when the frame is missing, or its maps differ in size.
  EdgeMaps Read(int frame_id) const;

 private:
  Hdf5File file_;
};

}  // namespace soslam

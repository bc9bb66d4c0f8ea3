// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "soslam/artefact/hdf5_file.h"
#include "soslam/artefact/json_file.h"
#include "soslam/image/edge_maps.h"
#include "soslam/model/estimates.h"

namespace soslam {

// Name of the text attribute of the root that holds the header of an HDF5 artefact, the same header
// as in JSON artefacts (ArtefactHeader).
inline constexpr const char* kHeaderAttribute = "artefact";

// Creates an artefact that has its header only.
Hdf5File CreateArtefact(const std::filesystem::path& path, const std::string& kind,
                        const ArtefactInfo& info);

// Opens an artefact for reading. Throws InputError when it is not of this kind or newer than this
// software supports.
Hdf5File OpenArtefact(const std::filesystem::path& path, const std::string& kind);

// The header of an artefact of any kind, JSON or HDF5; the format is recognised by the first bytes
// of the file, not by its name. Throws InputError when the file is neither, or has no header with
// its kind.
nlohmann::json ReadArtefactHeader(const std::filesystem::path& path);

// True if a file starts with the HDF5 signature.
bool IsHdf5(const std::filesystem::path& path);

// Writes edges.h5 (layout: schemas/hdf5-layout.md) frame by frame; it appears with Commit(). Throws
// SettingsError when it cannot be written.
class EdgesWriter {
 public:
  EdgesWriter(const std::filesystem::path& path, const ArtefactInfo& info);
  // Each frame once; the bytes of the file depend on the order.
  void Write(int frame_id, const EdgeMaps& maps);
  void Commit() { file_.Close(); }

 private:
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

// Writes symmetry.h5 (layout: schemas/hdf5-layout.md) atomically. At most one record per frame and
// object. Throws SettingsError when it cannot be written.
void WriteSymmetry(const std::filesystem::path& path, const std::vector<SymmetryRecord>& records,
                   const ArtefactInfo& info);

// The records, sorted by frame id, then object id. Throws InputError when the file is missing,
// damaged, not of kind "symmetry" or too new.
std::vector<SymmetryRecord> ReadSymmetry(const std::filesystem::path& path);

}  // namespace soslam

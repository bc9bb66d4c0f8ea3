// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "artefact/hdf5_file.h"
#include "artefact/json_file.h"

namespace soslam {

// Name of the text attribute of the root that holds the header of an HDF5 artefact, the same header
// as in JSON artefacts (ArtefactHeader).
inline constexpr const char* kHeaderAttribute = "artefact";
void WriteArtefactHeader(const std::string& kind, const ArtefactInfo& info, Hdf5File* file);

// Opens an artefact for reading. Throws InputError when it is not of this kind or newer than this
// software supports.
Hdf5File OpenArtefact(const std::filesystem::path& path, const std::string& kind);

// The header of an artefact of any kind, JSON or HDF5; the format is recognised by the first bytes
// of the file, not by its name. Throws InputError when the file is neither, or has no header with
// its kind.
nlohmann::json ReadArtefactHeader(const std::filesystem::path& path);

// True if a file starts with the HDF5 signature.
bool IsHdf5(const std::filesystem::path& path);

// Pixels as an n x 2 data set of float32; `count` is how many are expected.
void WritePixels(const std::string& name, const std::vector<Eigen::Vector2f>& pixels,
                 Hdf5File* file);
std::vector<Eigen::Vector2f> ReadPixels(const Hdf5File& file, const std::string& name,
                                        int count = Hdf5File::kAny);

}  // namespace soslam

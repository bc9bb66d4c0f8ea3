// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <istream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "model/finding.h"

namespace soslam {

// Absent values are null in every artefact.
template <typename Value>
nlohmann::json OrNull(const std::optional<Value>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

// Provenance of an artefact.
struct ArtefactInfo {
  nlohmann::json settings;                    // every option of the stage, resolved
  std::vector<std::filesystem::path> inputs;  // files that were read
  std::vector<Finding> findings = {};         // findings of the stage that writes it
};

// Parses any JSON file. Throws InputError with file and line when it is missing, empty or
// malformed, nested deeper than any artefact, or has the same key twice in an object.
nlohmann::json ParseJsonFile(const std::filesystem::path& path);
// ParseJsonFile for a text that is not a file of its own; `name` stands for it in error messages.
nlohmann::json ParseJsonText(std::istream& text, const std::string& name);

// A value as ASCII text, truncated to fit on a line.
std::string Excerpt(const nlohmann::json& value);

// The first fields of every header: kind, schema version, software version.
nlohmann::json HeaderOfKind(const std::string& kind);

// The header of an artefact: kind, schema version, software version, settings, and each input by
// file name with its SHA-256. JSON artefacts hold it as "artefact", HDF5 artefacts as an attribute.
nlohmann::json ArtefactHeader(const std::string& kind, const ArtefactInfo& info);

// Throws InputError, naming `file`, when the header is not of this kind, or its schema version is
// newer than this software supports.
void CheckArtefactHeader(const nlohmann::json& header, const std::string& kind,
                         const std::string& file);

// Reads an artefact of this kind, validated against schemas/<kind>.schema.json, with its header
// under "artefact". Throws InputError.
nlohmann::json ReadArtefact(const std::filesystem::path& path, const std::string& kind);

// Reads an artefact and converts it with `from_json`; adds the file's name to InputErrors that this
// throws.
template <typename FromJson>
auto ReadArtefactAs(const std::filesystem::path& path, const std::string& kind,
                    const FromJson& from_json) {
  const nlohmann::json document = ReadArtefact(path, kind);
  try {
    return from_json(document);
  } catch (const InputError& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

// Writes {"artefact": header, "findings": if any, ...body} atomically; an existing file with the
// same bytes keeps its modification time. Throws NumericalError, naming the place, for a number
// that is not finite; SettingsError when the file cannot be written; std::logic_error when the
// schema does not allow it.
void WriteArtefact(const std::filesystem::path& path, const std::string& kind,
                   const ArtefactInfo& info, nlohmann::json body);

}  // namespace soslam

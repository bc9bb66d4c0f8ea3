// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <functional>
#include <istream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "soslam/artefact/described_json.h"
#include "soslam/base/error.h"
#include "soslam/model/finding.h"

namespace soslam {

// Provenance of an artefact.
struct ArtefactInfo {
  nlohmann::json settings;                         // every option of the stage, resolved
  std::vector<std::filesystem::path> inputs = {};  // files that were read
  std::vector<Finding> findings = {};              // findings of the stage that writes it
  std::string stage = {};                          // its name: "planes"; empty for other programs
};

// Parses any JSON file. Throws InputError with file and line when it is missing, empty or
// malformed, nested deeper than any artefact, or has the same key twice in an object.
nlohmann::json ParseJsonFile(const std::filesystem::path& path);
// ParseJsonFile for a text that is not a file of its own; `name` stands for it in error messages.
nlohmann::json ParseJsonText(std::istream& text, const std::string& name);

// The document as text, on one line or with this indent. Bytes that are not UTF-8, as names of
// files may have, become U+FFFD.
std::string JsonText(const nlohmann::json& document, int indent = -1);

// The list "findings" of an artefact of any kind, which is absent when empty. Throws InputError.
std::vector<Finding> ReadFindings(const nlohmann::json& artefact);

// The header of an artefact, a FileHeader. JSON artefacts hold it as "artefact", HDF5 artefacts as
// an attribute.
nlohmann::json ArtefactHeader(const std::string& kind, const ArtefactInfo& info);

// Throws InputError, naming `file`, when the header is not of this kind, or its schema version is
// newer than this software supports.
void CheckArtefactHeader(const nlohmann::json& header, const std::string& kind,
                         const std::string& file);

// A value as ASCII text, truncated to fit on a line.
std::string Excerpt(const nlohmann::json& value);

// The reason why the field sha256 is no digest, in words; empty if it is one.
std::string DigestViolation(const std::string& sha256);

// [major, minor] of all schemas. A reader refuses newer ones, and files that lack what is required.
inline constexpr std::array<int, 2> kSchemaVersion = {1, 12};
inline constexpr const char* kSchemaVersionField = "schema_version";
extern const char* const kSoftware;  // name and version of this software

// The beginning of artefacts of all kinds.
struct FileHeader {
  struct Input {
    std::string file;
    std::string sha256;
  };
  std::string kind;
  std::array<int, 2> schema_version = {};
  std::string software;
  std::string stage;
  nlohmann::json settings;
  std::vector<Input> inputs;
};
template <typename Visitor>
void Describe(Visitor& visit, FileHeader::Input& input) {
  visit.Field("file", &input.file, "name without folder");
  visit.Field("sha256", &input.sha256, "SHA-256 of its bytes, 64 hexadecimal digits");
  visit.Check([&] { return DigestViolation(input.sha256); });
}
template <typename Visitor>
void Describe(Visitor& visit, FileHeader& header) {
  visit.Field("kind", &header.kind, "what the file is");
  visit.Field(kSchemaVersionField, &header.schema_version, "major, minor", kNotNegative);
  visit.Field("software", &header.software, "name and version of what wrote the file");
  visit.OrAbsent(
      "stage", &header.stage,
      "name of the stage that wrote the file, such as planes; absent also in older files",
      kNotEmpty);
  visit.Field("settings", &header.settings, "every option of the stage that wrote it");
  visit.Check([&] {
    return header.settings.is_object()
               ? std::string()
               : "settings is " + Excerpt(header.settings) + "; expected an object with fields";
  });
  visit.Field("inputs", &header.inputs, "files that were read");
}

// An artefact with its body: the result of a stage, which has a description.
template <typename Body>
struct Artefact {
  FileHeader header;
  std::vector<Finding> findings;
  Body body;
};
template <typename Visitor, typename Body>
void Describe(Visitor& visit, Artefact<Body>& artefact) {
  visit.Field("artefact", &artefact.header, "what this file is and what shaped it");
  visit.OrAbsent("findings", &artefact.findings, "what does not fit what it should be");
  Describe(visit, artefact.body);
}

namespace internal {

// Parses a file and checks its header.
nlohmann::json ParseArtefact(const std::filesystem::path& path, const std::string& kind);
// Calls `read`, and adds to its InputErrors the file's name and, where that is another one, its
// schema version.
void ReadInFile(const std::filesystem::path& path, const nlohmann::json& document,
                const std::function<void()>& read);
// Throws InputError for rows of the same ids.
void RefuseRowsTwice(const nlohmann::json& document, const std::string& kind);

}  // namespace internal

// The value in a document without a header. Throws InputError, naming `where` and the field.
template <typename Value>
Value ReadDocument(const nlohmann::json& document, const std::string& where) {
  Value value = {};
  internal::ReadInFile(where, document, [&] { value = DescribedFromJson<Value>(document); });
  return value;
}

// Reads an artefact of this kind by the description of its body. Throws InputError, naming file and
// field.
template <typename Body>
Artefact<Body> ReadDescribed(const std::filesystem::path& path, const std::string& kind,
                             const Sequence* sequence = nullptr) {
  const nlohmann::json document = internal::ParseArtefact(path, kind);
  Artefact<Body> artefact;
  internal::ReadInFile(path, document, [&] {
    artefact = DescribedFromJson<Artefact<Body>>(document, sequence);
    internal::RefuseRowsTwice(document, kind);
  });
  return artefact;
}

// Reads an artefact of this kind, as its kind describes it, without rows of the same ids, with its
// header under "artefact". Throws InputError.
nlohmann::json ReadArtefact(const std::filesystem::path& path, const std::string& kind);

// The text of an artefact: {"artefact": header, "findings": if any, ...body}. `path` is for error
// messages. Throws NumericalError, naming the place, for a number that is not finite;
// std::logic_error when the schema does not allow it.
std::string ArtefactText(const std::filesystem::path& path, const std::string& kind,
                         const ArtefactInfo& info, nlohmann::json body);

// Writes this text atomically; an existing file with the same bytes keeps its modification time.
// Errors as ArtefactText; SettingsError when the file cannot be written.
void WriteArtefact(const std::filesystem::path& path, const std::string& kind,
                   const ArtefactInfo& info, nlohmann::json body);

}  // namespace soslam

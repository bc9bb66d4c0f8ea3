// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/files.h"
#include "soslam/base/error.h"

namespace soslam {

namespace {

constexpr const char* kSemanticTableKind = "semantic_table";

}  // namespace

SemanticRows ReadSemanticRows(const std::filesystem::path& path) {
  nlohmann::json document = ParseJsonFile(path);
  // Tables written by people have no header.
  if (document.is_object() && document.contains("artefact")) {
    return ReadDescribed<SemanticRows>(path, kSemanticTableKind).body;
  }
  SemanticRows rows;
  internal::ReadInFile(path, document, [&] { rows = DescribedFromJson<SemanticRows>(document); });
  return rows;
}

SemanticTable ReadSemanticTable(const std::filesystem::path& path) {
  const SemanticRows rows = ReadSemanticRows(path);
  try {
    return LookUpTable(rows);
  } catch (const InputError& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

void WriteSemanticRows(const std::filesystem::path& path, const SemanticRows& rows,
                       const ArtefactInfo& info) {
  WriteArtefact(path, kSemanticTableKind, info, DescribedToJson(rows));
}

}  // namespace soslam

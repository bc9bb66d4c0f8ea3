// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/json_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <stdexcept>

#include "soslam/artefact/atomic_file.h"
#include "soslam/artefact/kinds.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/image/file_kind.h"
#include "soslam/system/run_log.h"

namespace soslam {
namespace {

using nlohmann::json;

void RefuseNonFinite(const json& value, const json::json_pointer& place, const std::string& file) {
  if (value.is_number_float() && !std::isfinite(value.get<double>())) {
    throw NumericalError(fmt::format("{}: {} would be {}; expected a finite number", file,
                                     place.to_string(), value.get<double>()));
  }
  if (value.is_object()) {
    for (const auto& item : value.items()) RefuseNonFinite(item.value(), place / item.key(), file);
  }
  if (value.is_array()) {
    for (size_t i = 0; i < value.size(); ++i) RefuseNonFinite(value[i], place / i, file);
  }
}

}  // namespace

json ParseJsonFile(const std::filesystem::path& path) {
  RecordInput(path);
  const std::string file = path.string();
  std::ifstream stream(path, std::ios::binary);
  if (!stream || IsFolder(path)) {
    std::error_code error;
    const bool is_missing = !std::filesystem::exists(path, error) && !error;
    throw InputError(file + (is_missing ? ": no such file" : ": cannot be read") +
                     "; expected a JSON file");
  }
  return ParseJsonText(stream, file);
}

json ParseJsonText(std::istream& text, const std::string& name) {
  if (text.peek() == std::istream::traits_type::eof()) {
    throw InputError(name + ": is empty; expected JSON");
  }
  // Rejects duplicate keys, of which nlohmann silently keeps the last, and deep nesting, which
  // would exhaust the stack in recursive code.
  std::vector<std::set<std::string>> keys_of_open_objects;
  const auto check = [&](int depth, json::parse_event_t event, const json& parsed) {
    constexpr int kMaxDepth = 100;
    const bool begins =
        event == json::parse_event_t::object_start || event == json::parse_event_t::array_start;
    if (begins && depth >= kMaxDepth) {
      throw InputError(
          fmt::format("{}: is nested more than {} levels deep; expected less", name, kMaxDepth));
    }
    if (event == json::parse_event_t::object_start) {
      keys_of_open_objects.emplace_back();
    } else if (event == json::parse_event_t::object_end) {
      keys_of_open_objects.pop_back();
    } else if (event == json::parse_event_t::key &&
               !keys_of_open_objects.back().insert(parsed.get<std::string>()).second) {
      throw InputError(
          fmt::format("{}: key {} twice in one object; expected once", name, parsed.dump()));
    }
    return true;
  };
  try {
    return json::parse(text, check);
  } catch (const json::exception& error) {
    std::string begin(kFileKindSize, '\0');
    text.clear();
    text.seekg(0);
    text >> std::ws;
    text.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    begin.resize(static_cast<size_t>(text.gcount()));
    const std::string kind = FileKind(begin);
    if (kind != "JSON") {
      throw InputError(fmt::format("{}: {}; expected JSON in UTF-8", name,
                                   kind.empty() ? "begins with neither { nor [" : "is " + kind));
    }
    const std::string message = error.what();  // "[json.exception.parse_error.101] parse error ..."
    throw InputError(name + ": " + message.substr(message.find("] ") + 2));
  }
}

std::string JsonText(const json& document, int indent) {
  return document.dump(indent, ' ', /*ensure_ascii=*/false, json::error_handler_t::replace);
}

std::string DigestViolation(const std::string& sha256) {
  const bool is_digest =
      sha256.size() == 64 && sha256.find_first_not_of("0123456789abcdef") == sha256.npos;
  return is_digest ? "" : fmt::format("sha256 is \"{}\"; expected 64 hexadecimal digits", sha256);
}

std::vector<Finding> ReadFindings(const json& artefact) {
  if (!artefact.is_object()) throw InputError("is no object; expected an artefact");
  return DescribedFromJson<std::vector<Finding>>(artefact.value("findings", json::array()));
}

std::string Excerpt(const json& value) {
  constexpr size_t kMaxLength = 60;
  const std::string text =
      value.dump(-1, ' ', /*ensure_ascii=*/true, json::error_handler_t::replace);
  return text.size() <= kMaxLength ? text : text.substr(0, kMaxLength) + "...";
}

const char* const kSoftware = "soslam " SOSLAM_VERSION;

json ArtefactHeader(const std::string& kind, const ArtefactInfo& info) {
  FileHeader header = {kind,
                       kSchemaVersion,
                       kSoftware,
                       info.stage,
                       info.settings.is_null() ? json::object() : info.settings,
                       {}};
  for (const auto& input : info.inputs) {
    header.inputs.push_back({input.filename().string(), DigestOfInput(input)});
  }
  std::ranges::sort(header.inputs, {}, [](const FileHeader::Input& input) {
    return std::pair(input.file, input.sha256);
  });
  return DescribedToJson(header);
}

void CheckArtefactHeader(const json& header, const std::string& kind, const std::string& file) {
  if (!header.is_object() || !header.contains("kind") || !header.contains(kSchemaVersionField)) {
    throw InputError(fmt::format(
        "{}: has no artefact header with kind and schema_version; expected one of kind '{}'", file,
        kind));
  }
  if (header["kind"] != kind) {
    throw InputError(
        fmt::format("{}: artefact kind is {}; expected \"{}\"", file, header["kind"].dump(), kind));
  }
  const json& version = header[kSchemaVersionField];
  const auto is_count = [](const json& number) { return number.is_number_unsigned(); };
  if (!version.is_array() || version.size() != 2 || !std::ranges::all_of(version, is_count)) {
    throw InputError(
        fmt::format("{}: schema_version is {}; expected [major, minor]", file, version.dump()));
  }
  if (version > json(kSchemaVersion)) {
    throw InputError(
        fmt::format("{}: has schema version [{}] of kind '{}'; this software reads up to [{}]",
                    file, fmt::join(version.get<std::vector<std::uint64_t>>(), ", "), kind,
                    fmt::join(kSchemaVersion, ", ")));
  }
}

void internal::RefuseRowsTwice(const json& document, const std::string& kind) {
  // A list of a kind of artefact, each of whose rows has other ids under these keys.
  struct RowIds {
    const char* kind;
    const char* list;
    std::vector<const char*> keys;
  };
  static const std::vector<RowIds> kRowIds = {{"landmarks", "observations", {"frame", "object"}},
                                              {"landmarks", "objects", {"object"}},
                                              {"map", "objects", {"object"}},
                                              {"metrics", "objects", {"object"}},
                                              {"planes", "planes", {"plane"}},
                                              {"planes", "objects", {"object"}}};
  for (const RowIds& ids : kRowIds) {
    if (ids.kind != kind) continue;
    const json& rows = document.at(ids.list);
    std::set<std::vector<json>> seen;
    for (size_t i = 0; i < rows.size(); ++i) {
      std::vector<json> values;
      for (const char* key : ids.keys) values.push_back(rows[i].at(key));
      if (seen.insert(values).second) continue;
      std::vector<std::string> names;
      for (const char* key : ids.keys) {
        names.push_back(fmt::format("{} {}", key, rows[i].at(key).dump()));
      }
      throw InputError(fmt::format("/{}/{} is the second row of {}; expected one", ids.list, i,
                                   fmt::join(names, ", ")));
    }
  }
}

json internal::ParseArtefact(const std::filesystem::path& path, const std::string& kind) {
  json document = ParseJsonFile(path);
  const json header = document.is_object() ? document.value("artefact", json()) : json();
  CheckArtefactHeader(header, kind, path.string());
  return document;
}

void internal::ReadInFile(const std::filesystem::path& path, const json& document,
                          const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    const json header = document.is_object() ? document.value("artefact", json()) : json();
    const json version = header.is_object()
                             ? header.value(kSchemaVersionField, json(kSchemaVersion))
                             : json(kSchemaVersion);
    throw InputError(fmt::format(
        "{}: {}{}", path.string(), error.what(),
        version == json(kSchemaVersion)
            ? ""
            : fmt::format("; its schema version is {}, that of this software [{}]: run the stage "
                          "that made it again",
                          version.dump(), fmt::join(kSchemaVersion, ", "))));
  }
}

json ReadArtefact(const std::filesystem::path& path, const std::string& kind) {
  json document = internal::ParseArtefact(path, kind);
  const ArtefactKind* const described = FindArtefactKind(kind);
  if (described == nullptr) {
    throw InputError(
        fmt::format("{}: artefact kind is \"{}\"; expected one that is JSON", path.string(), kind));
  }
  internal::ReadInFile(path, document, [&] {
    described->check(document);
    internal::RefuseRowsTwice(document, kind);
  });
  return document;
}

std::string ArtefactText(const std::filesystem::path& path, const std::string& kind,
                         const ArtefactInfo& info, json body) {
  body["artefact"] = ArtefactHeader(kind, info);
  if (!info.findings.empty()) body["findings"] = DescribedToJson(info.findings);
  RefuseNonFinite(body, json::json_pointer(), path.string());
  const ArtefactKind* const described = FindArtefactKind(kind);
  if (described == nullptr) throw std::logic_error("no artefacts are of kind " + kind);
  try {
    described->check(body);
  } catch (const InputError& error) {
    throw std::logic_error(fmt::format("{}: would break the schema of kind '{}': {}", path.string(),
                                       kind, error.what()));
  }
  return JsonText(body, 1) + "\n";
}

void WriteArtefact(const std::filesystem::path& path, const std::string& kind,
                   const ArtefactInfo& info, json body) {
  WriteTextFile(path, ArtefactText(path, kind, info, std::move(body)));
}

}  // namespace soslam

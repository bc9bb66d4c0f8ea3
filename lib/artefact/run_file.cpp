// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/run_file.h"

#include <archive.h>
#include <ceres/version.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <openssl/crypto.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <opencv2/core/utility.hpp>
#include <stdexcept>

#include "artefact/atomic_file.h"
#include "artefact/json_file.h"
#include "artefact/model_json.h"
#include "base/error.h"

namespace soslam {
namespace {

std::string CompilerVersion() {
#if defined(__clang__)
  return "Clang " __clang_version__;
#else
  return "GCC " __VERSION__;
#endif
}

std::string Hdf5Version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

// Decodes FMT_VERSION: 90101 is "9.1.1".
std::string FmtVersion() {
  return fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100);
}

// Version number in "libarchive 3.6.2".
std::string LibArchiveVersion() {
  const std::string text = archive_version_string();
  return text.substr(text.rfind(' ') + 1);
}

}  // namespace

Software ThisSoftware() {
  return {"soslam " SOSLAM_VERSION,
          CompilerVersion(),
          {{"ceres", CERES_VERSION_STRING},
           {"cli11", CLI11_VERSION},
           {"eigen",
            fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
           {"fmt", FmtVersion()},
           {"hdf5", Hdf5Version()},
           {"libarchive", LibArchiveVersion()},
           {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                         NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
           {"opencv", cv::getVersionString()},
           {"openssl", OpenSSL_version(OPENSSL_VERSION_STRING)}}};
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunSetting, value, origin)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunFile, argument, relative_to, path, sha256)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunRecord, stage, settings, allow_outside_paths, seed, folders,
                                   inputs, outputs, exit_code, timing)

namespace {

using nlohmann::json;

constexpr const char* kRunKind = "run";

void CheckBases(const std::vector<RunFile>& files, const RunRecord& record,
                const std::string& place) {
  for (size_t i = 0; i < files.size(); ++i) {
    const std::string& base = files[i].relative_to;
    if (base != kRelativeToRun && base != kRelativeToCall && !record.folders.contains(base)) {
      throw InputError(
          fmt::format("{}/{}/relative_to is \"{}\"; expected \"{}\", \"{}\" or one of /folders",
                      place, i, base, kRelativeToRun, kRelativeToCall));
    }
  }
}

RunRecord RunFromJson(const json& document) {
  auto record = document.get<RunRecord>();
  record.software = {document.at("artefact").at("software"), document.at("compiler"),
                     document.at("libraries")};
  record.called_in = document.at("called_in").get<std::string>();
  CheckBases(record.inputs, record, "/inputs");
  CheckBases(record.outputs, record, "/outputs");
  if (!document.at("error").is_null()) record.error = document.at("error");
  return record;
}

}  // namespace

void WriteRun(const std::filesystem::path& path, const RunRecord& record) {
  json document = record;
  document.update({{"artefact", HeaderOfKind(kRunKind)},
                   {"compiler", record.software.compiler},
                   {"libraries", record.software.libraries},
                   {"called_in", record.called_in.string()},
                   {"error", NullIfEmpty(record.error)}});
  if (const auto violation = SchemaViolation(document, kRunKind)) {
    throw std::logic_error(
        fmt::format("{}: would break its schema: {}", path.string(), *violation));
  }
  WriteTextFile(path, JsonText(document, 2) + "\n");
}

RunRecord ReadRun(const std::filesystem::path& path) {
  return ReadArtefactAs(path, kRunKind, &RunFromJson);
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/run_file.h"

#include <archive.h>
#include <ceres/version.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <openssl/crypto.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <opencv2/core/utility.hpp>
#include <stdexcept>

#include "soslam/artefact/atomic_file.h"
#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"

namespace soslam {

Software ThisSoftware() {
#if defined(__clang__)
  const std::string compiler = "Clang " __clang_version__;
#else
  const std::string compiler = "GCC " __VERSION__;
#endif
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  const std::string archive = archive_version_string();  // such as "libarchive 3.6.2"
  return {kSoftware,
          compiler,
          {{"ceres", CERES_VERSION_STRING},
           {"cli11", CLI11_VERSION},
           {"eigen",
            fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
           // FMT_VERSION of 9.1.1 is 90101.
           {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
                               FMT_VERSION % 100)},
           {"hdf5", fmt::format("{}.{}.{}", major, minor, release)},
           {"libarchive", archive.substr(archive.rfind(' ') + 1)},
           {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                         NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
           {"opencv", cv::getVersionString()},
           {"openssl", OpenSSL_version(OPENSSL_VERSION_STRING)}}};
}

// The header of run.json, which has settings and inputs of its own.
struct RunHeader {
  std::string kind;
  std::array<int, 2> schema_version;
  std::string software;
};
template <typename Visitor>
void Describe(Visitor& visit, RunHeader& header) {
  visit.Field("kind", &header.kind, "run");
  visit.Field(kSchemaVersionField, &header.schema_version, "major, minor", kNotNegative);
  visit.Field("software", &header.software, "name and version");
}
struct RunDocument {
  RunHeader header;
  RunRecord record;
};
template <typename Visitor>
void Describe(Visitor& visit, RunDocument& run) {
  visit.Field("artefact", &run.header, "what this file is");
  Describe(visit, run.record);
}

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

}  // namespace

void WriteRun(const std::filesystem::path& path, const RunRecord& record) {
  const json document = DescribedToJson(RunDocument{{kRunKind, kSchemaVersion, kSoftware}, record});
  try {
    DescribedFromJson<RunDocument>(document);
  } catch (const InputError& error) {
    throw std::logic_error(fmt::format("{}: {}", path.string(), error.what()));
  }
  WriteTextFile(path, JsonText(document, 2) + "\n");
}

nlohmann::ordered_json RunSchema() { return SchemaWriter::Of<RunDocument>(); }

RunRecord ReadRun(const std::filesystem::path& path) {
  const json document = internal::ParseArtefact(path, kRunKind);
  RunRecord record;
  internal::ReadInFile(path, document, [&] {
    auto [header, read] = DescribedFromJson<RunDocument>(document);
    record = std::move(read);
    record.software.version = header.software;
    CheckBases(record.inputs, record, "/inputs");
    CheckBases(record.outputs, record, "/outputs");
  });
  return record;
}

}  // namespace soslam

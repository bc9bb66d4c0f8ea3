// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/software.h"

#include <archive.h>
#include <ceres/version.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <openssl/crypto.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>

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

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/system/run_log.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void RefuseToWrite(const fs::path& path, const std::string& reason) {
  throw SettingsError(fmt::format("{}: cannot be written: {}", path.string(), reason));
}

fs::path FolderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

bool SameBytes(const fs::path& a, const fs::path& b) {
  std::ifstream stream_a(a, std::ios::binary);
  std::ifstream stream_b(b, std::ios::binary);
  using Bytes = std::istreambuf_iterator<char>;
  return stream_a && stream_b && std::equal(Bytes(stream_a), Bytes(), Bytes(stream_b), Bytes());
}

}  // namespace

int SyncWith(int (*sync)(int), const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int error = sync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  return error;
}

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)) {
  if (IsFolder(path_)) RefuseToWrite(path_, "it is a folder");
  std::random_device random;
  temporary_ = FolderOf(path_) /
               fmt::format(".{}.{:08x}{:08x}.tmp", path_.filename().string(), random(), random());
  const int descriptor = ::open(temporary_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor < 0) RefuseToWrite(path_, std::strerror(errno));
  ::close(descriptor);
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void AtomicFile::Commit() {
  CheckInputsUnchanged();
  if (const int error = SyncWith(::fsync, temporary_)) RefuseToWrite(path_, std::strerror(error));
  if (SameBytes(temporary_, path_)) {
    fs::remove(temporary_);
  } else {
    std::error_code error;
    fs::rename(temporary_, path_, error);
    if (error) RefuseToWrite(path_, error.message());
    SyncWith(::fsync, FolderOf(path_));
  }
  temporary_.clear();
  RecordOutput(path_);
}

void WriteTextFile(const fs::path& path, std::string_view text) {
  AtomicFile file(path);
  std::ofstream stream(file.TemporaryPath(), std::ios::binary);
  errno = 0;
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) RefuseToWrite(path, errno != 0 ? std::strerror(errno) : "write error");
  file.Commit();
}

}  // namespace soslam

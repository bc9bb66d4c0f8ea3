// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/hdf5_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hdf5.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <numeric>
#include <span>
#include <type_traits>

#include "soslam/artefact/hdf5_types.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/image/file_kind.h"
#include "soslam/system/run_log.h"

namespace soslam {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t> && std::is_same_v<herr_t, int>);

// Limit beyond any image that can be processed; a damaged size must not exhaust the memory.
constexpr std::uint64_t kMaxValues = std::uint64_t{1} << 28;

// Largest compression ratio of deflate, reached for zeros.
constexpr std::uint64_t kMaxPacking = 1032;

constexpr const char* kDamaged = "cannot be read; the file is cut short or damaged";

// The prefixes of "/a/b/c": "/a", "/a/b", "/a/b/c".
std::vector<std::string> Prefixes(const std::string& name) {
  std::vector<std::string> prefixes;
  for (size_t slash = name.find('/', 1); slash != name.npos; slash = name.find('/', slash + 1)) {
    prefixes.push_back(name.substr(0, slash));
  }
  if (name.size() > 1) prefixes.push_back(name);
  return prefixes;
}

std::string Describe(const std::vector<int>& expected, const char* element) {
  std::vector<std::string> sizes;
  for (const int size : expected) {
    sizes.push_back(size == Hdf5File::kAny ? "any" : std::to_string(size));
  }
  return fmt::format("{} of {}", fmt::join(sizes, " x "), element);
}

// Callback of iterations over names, in which `list` is a vector of texts.
template <typename Info>
herr_t AppendName(hid_t /*owner*/, const char* name, const Info* /*info*/, void* list) {
  static_cast<std::vector<std::string>*>(list)->emplace_back(name);
  return 0;
}

size_t CountValues(const ArrayShape& shape) {
  return std::accumulate(shape.begin(), shape.end(), size_t{1}, std::multiplies<>());
}

// Lock on the library for one thread. A thread-safe build of the library has an error stack per
// thread: it is not printed, and is cleared at the end, as the library leaks it when the thread
// ends.
class Hdf5Lock {
 public:
  Hdf5Lock() : lock_(Mutex()) { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }
  ~Hdf5Lock() { H5Eclear2(H5E_DEFAULT); }
  Hdf5Lock(const Hdf5Lock&) = delete;
  Hdf5Lock& operator=(const Hdf5Lock&) = delete;

 private:
  static std::mutex& Mutex() {
    static std::mutex mutex;
    return mutex;
  }

  std::lock_guard<std::mutex> lock_;
};

}  // namespace

bool Hdf5Handle::Close() {
  if (!valid()) return true;
  return close_(std::exchange(id_, kInvalid)) >= 0;
}

Hdf5File::Hdf5File(std::filesystem::path path, std::int64_t id)
    : path_(std::move(path)), file_(id, &H5Fclose) {}

Hdf5File Hdf5File::Create(const std::filesystem::path& path) {
  auto atomic = std::make_unique<AtomicFile>(path);
  const Hdf5Handle access = Hdf5FileAccess();
  const Hdf5Handle creation = Hdf5Timeless(H5P_FILE_CREATE);
  errno = 0;
  Hdf5File file(
      path, H5Fcreate(atomic->TemporaryPath().c_str(), H5F_ACC_TRUNC, creation.id(), access.id()));
  if (!file.file_.valid()) file.FailWriting("/");
  file.atomic_ = std::move(atomic);
  return file;
}

Hdf5File Hdf5File::Open(const std::filesystem::path& path) {
  if (!IsFile(path)) {
    throw InputError(fmt::format("{}: no such file; expected an HDF5 file", path.string()));
  }
  RecordInput(path);
  const Hdf5Handle access = Hdf5FileAccess();
  Hdf5File file(path, H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()));
  if (file.file_.valid()) return file;
  if (H5Fis_hdf5(path.c_str()) > 0) {
    throw InputError(fmt::format("{}: {}; expected a whole HDF5 file", path.string(), kDamaged));
  }
  const std::string kind = KindOfFile(path);
  throw InputError(path.string() + (kind.empty() ? ": is not an HDF5 file; expected one"
                                                 : ": is " + kind + "; expected an HDF5 file"));
}

void Hdf5File::FailWriting(const std::string& name) const {
  // Error of the system call in which the HDF5 library failed.
  const std::string reason = errno == 0 ? "" : fmt::format(": {}", std::strerror(errno));
  throw SettingsError(fmt::format("{}: {} cannot be written{}", path_.string(), name, reason));
}

void Hdf5File::FailReading(const std::string& name, const std::string& problem) const {
  throw InputError(fmt::format("{}: {}: {}", path_.string(), name, problem));
}

void Hdf5File::WriteGroup(const std::string& name) {
  errno = 0;
  // Creates parent groups one by one: those that HDF5 creates itself store times.
  const Hdf5Handle creation = Hdf5Timeless(H5P_GROUP_CREATE);
  for (const std::string& prefix : Prefixes(name)) {
    if (H5Lexists(file_.id(), prefix.c_str(), H5P_DEFAULT) > 0) continue;
    const Hdf5Handle group{
        H5Gcreate2(file_.id(), prefix.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), &H5Gclose};
    if (!group.valid()) FailWriting(prefix);
  }
}

void Hdf5File::WriteMatrix(const std::string& name, const cv::Mat& matrix) {
  const cv::Mat whole = matrix.isContinuous() ? matrix : matrix.clone();
  ArrayShape shape = {static_cast<size_t>(matrix.rows), static_cast<size_t>(matrix.cols)};
  if (matrix.channels() > 1) shape.push_back(static_cast<size_t>(matrix.channels()));
  WriteArray(name, shape, matrix.depth(), whole.data);
}

void Hdf5File::WriteArray(const std::string& name, const ArrayShape& shape, int depth,
                          const void* values) {
  WriteGroup(name.substr(0, name.rfind('/')));
  const Hdf5Element element = Hdf5ElementOf(depth);
  const std::vector<hsize_t> sizes(shape.begin(), shape.end());
  const Hdf5Handle space{H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr),
                         &H5Sclose};
  const Hdf5Handle creation = Hdf5DataSetCreation(shape);
  Hdf5Handle data_set{H5Dcreate2(file_.id(), name.c_str(), element.type, space.id(), H5P_DEFAULT,
                                 creation.id(), H5P_DEFAULT),
                      &H5Dclose};
  const bool written = data_set.valid() && H5Dwrite(data_set.id(), element.type, H5S_ALL, H5S_ALL,
                                                    H5P_DEFAULT, values) >= 0;
  if (!data_set.Close() || !written) FailWriting(name);
}

void Hdf5File::WriteAttribute(const std::string& owner, const std::string& name, std::int64_t type,
                              const void* value) {
  errno = 0;
  const Hdf5Handle space{H5Screate(H5S_SCALAR), &H5Sclose};
  const Hdf5Handle attribute{H5Acreate_by_name(file_.id(), owner.c_str(), name.c_str(), type,
                                               space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                             &H5Aclose};
  const bool written = attribute.valid() && H5Awrite(attribute.id(), type, value) >= 0;
  if (!written) FailWriting(owner + " attribute " + name);
}

void Hdf5File::WriteText(const std::string& owner, const std::string& name,
                         const std::string& text) {
  const Hdf5Handle type{H5Tcopy(H5T_C_S1), &H5Tclose};
  H5Tset_size(type.id(), std::max<size_t>(text.size(), 1));  // HDF5 has no length 0
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  WriteAttribute(owner, name, type.id(), text.c_str());
}

void Hdf5File::WriteNumber(const std::string& owner, const std::string& name, double number) {
  WriteAttribute(owner, name, H5T_IEEE_F64LE, &number);
}

void Hdf5File::Close() {
  errno = 0;
  const bool flushed = H5Fflush(file_.id(), H5F_SCOPE_LOCAL) >= 0;
  if (!file_.Close() || !flushed) FailWriting("/");
  atomic_->Commit();
}

bool Hdf5File::Has(const std::string& name) const {
  const std::vector<std::string> prefixes = Prefixes(name);
  return std::ranges::all_of(prefixes, [&](const std::string& prefix) {
    return H5Lexists(file_.id(), prefix.c_str(), H5P_DEFAULT) > 0;
  });
}

bool Hdf5File::HasAttribute(const std::string& owner, const std::string& name) const {
  return H5Aexists_by_name(file_.id(), owner.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Hdf5File::Children(const std::string& group) const {
  std::vector<std::string> names;
  if (H5Literate_by_name(file_.id(), group.c_str(), H5_INDEX_NAME, H5_ITER_INC, nullptr,
                         AppendName<H5L_info_t>, &names, H5P_DEFAULT) < 0) {
    FailReading(group, Has(group) ? kDamaged : "missing; expected a group");
  }
  return names;
}

std::uint64_t Hdf5File::Size() const {
  hsize_t bytes = 0;
  H5Fget_filesize(file_.id(), &bytes);
  return bytes;
}

void Hdf5File::RequireWalkable() const {
  constexpr int kMaxDepth = 8;  // artefacts have 3
  constexpr size_t kMaxPlaces = 1 << 18;
  size_t places = 0;
  std::vector<std::pair<std::string, int>> groups = {{"/", 1}};
  while (!groups.empty()) {
    const auto [group, depth] = groups.back();
    groups.pop_back();
    for (const std::string& name : Children(group)) {
      if (++places > kMaxPlaces) FailReading("/", "has more places than any artefact");
      if (!IsGroup(group + name)) continue;
      if (depth == kMaxDepth) {
        FailReading("/", fmt::format("has groups nested more than {} deep, or in each other; "
                                     "expected a tree of a few levels",
                                     kMaxDepth));
      }
      groups.emplace_back(group + name + "/", depth + 1);
    }
  }
}

ArrayShape Hdf5File::ReadShape(const std::string& name, const Hdf5Handle& data_set) const {
  const Hdf5Handle space{H5Dget_space(data_set.id()), &H5Sclose};
  const int rank = H5Sget_simple_extent_ndims(space.id());
  if (rank < 0) FailReading(name, kDamaged);
  std::vector<hsize_t> sizes(static_cast<size_t>(rank));
  H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr);
  ArrayShape shape(sizes.begin(), sizes.end());
  std::uint64_t values = 1;
  for (const std::uint64_t size : shape) {
    if (size > kMaxValues || (values *= size) > kMaxValues) {
      FailReading(name, fmt::format("is {}; expected at most {} values", fmt::join(shape, " x "),
                                    kMaxValues));
    }
  }
  return shape;
}

void Hdf5File::ReadArray(const std::string& name, int depth, const std::vector<int>& expected,
                         const std::function<void*(const ArrayShape&)>& allocate) const {
  const auto element_size = static_cast<size_t>(CV_ELEM_SIZE1(depth));
  ArrayShape shape;
  std::optional<std::string> chunk;
  {
    const Hdf5Lock turn;
    const Hdf5Element element = Hdf5ElementOf(depth);
    if (!Has(name)) FailReading(name, "missing; expected " + Describe(expected, element.name));
    const Hdf5Handle data_set{H5Dopen2(file_.id(), name.c_str(), H5P_DEFAULT), &H5Dclose};
    const Hdf5Handle type{H5Dget_type(data_set.id()), &H5Tclose};
    shape = ReadShape(name, data_set);
    const bool same_type = H5Tequal(type.id(), element.type) > 0;
    const bool same_shape =
        std::equal(shape.begin(), shape.end(), expected.begin(), expected.end(),
                   [](std::uint64_t size, int wanted) {
                     return wanted == kAny || size == static_cast<std::uint64_t>(wanted);
                   });
    if (!same_type || !same_shape) {
      FailReading(name, fmt::format("is {} of {}; expected {}", fmt::join(shape, " x "),
                                    same_type ? element.name : "another type",
                                    Describe(expected, element.name)));
    }
    chunk = ReadChunk(data_set, shape, Size());
  }
  const size_t bytes = CountValues(shape) * element_size;
  if (bytes > 0 && !chunk) {
    FailReading(name,
                "is not stored in this file as one chunk, shuffled and deflated; the file is of "
                "another program, cut short or damaged");
  }
  if (bytes > 0 && bytes > kMaxPacking * chunk->size()) {
    FailReading(name, "has fewer bytes than its size needs; the file is cut short or damaged");
  }
  const std::span<std::byte> values(static_cast<std::byte*>(allocate(shape)), bytes);
  if (bytes > 0 && !DecodeChunk(*chunk, element_size, values)) FailReading(name, kDamaged);
}

bool Hdf5File::IsGroup(const std::string& name) const {
  const Hdf5Handle group{H5Gopen2(file_.id(), name.c_str(), H5P_DEFAULT), &H5Gclose};
  return group.valid();
}

Hdf5File::Numbers Hdf5File::ReadNumbers(const std::string& name) const {
  const Hdf5Handle data_set{H5Dopen2(file_.id(), name.c_str(), H5P_DEFAULT), &H5Dclose};
  if (!data_set.valid()) FailReading(name, "is neither a group nor a data set; expected one");
  const Hdf5Handle type{H5Dget_type(data_set.id()), &H5Tclose};
  Numbers numbers{ReadShape(name, data_set), {}};
  for (const int depth : {CV_8U, CV_16S, CV_32S, CV_32F, CV_64F}) {
    if (H5Tequal(type.id(), Hdf5ElementOf(depth).type) <= 0) continue;
    cv::Mat stored;
    ReadArray(name, depth, {numbers.shape.begin(), numbers.shape.end()},
              [&](const ArrayShape& shape) {
                stored.create(1, static_cast<int>(CountValues(shape)), depth);
                return stored.data;
              });
    stored.convertTo(numbers.values, CV_64F);
    return numbers;
  }
  FailReading(name, "is of another type; expected numbers as artefacts have them");
}

cv::Mat Hdf5File::ReadMatrix(const std::string& name, int type, int rows, int columns) const {
  std::vector<int> expected = {rows, columns};
  if (CV_MAT_CN(type) > 1) expected.push_back(CV_MAT_CN(type));
  cv::Mat matrix;
  ReadArray(name, CV_MAT_DEPTH(type), expected, [&](const ArrayShape& shape) {
    matrix.create(static_cast<int>(shape[0]), static_cast<int>(shape[1]), type);
    return matrix.data;
  });
  return matrix;
}

std::vector<std::string> Hdf5File::Attributes(const std::string& owner) const {
  std::vector<std::string> names;
  if (H5Aiterate_by_name(file_.id(), owner.c_str(), H5_INDEX_NAME, H5_ITER_INC, nullptr,
                         AppendName<H5A_info_t>, &names, H5P_DEFAULT) < 0) {
    FailReading(owner, kDamaged);
  }
  return names;
}

Hdf5Handle Hdf5File::OpenAttribute(const std::string& owner, const std::string& name) const {
  return {H5Aopen_by_name(file_.id(), owner.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
          &H5Aclose};
}

bool Hdf5File::IsText(const std::string& owner, const std::string& attribute) const {
  const Hdf5Handle opened = OpenAttribute(owner, attribute);
  const Hdf5Handle type{H5Aget_type(opened.id()), &H5Tclose};
  return H5Tget_class(type.id()) == H5T_STRING;
}

std::string Hdf5File::ReadText(const std::string& owner, const std::string& name) const {
  const std::string where = owner + " attribute " + name;
  if (!HasAttribute(owner, name)) FailReading(where, "missing; expected a text");
  const Hdf5Handle attribute = OpenAttribute(owner, name);
  const Hdf5Handle type{H5Aget_type(attribute.id()), &H5Tclose};
  const Hdf5Handle space{H5Aget_space(attribute.id()), &H5Sclose};
  if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) != 0 ||
      H5Sget_simple_extent_npoints(space.id()) != 1) {
    FailReading(where, "is not a text of fixed length; expected one");
  }
  if (H5Tget_size(type.id()) > Size()) FailReading(where, kDamaged);
  std::string text(H5Tget_size(type.id()), '\0');
  if (H5Aread(attribute.id(), type.id(), text.data()) < 0) FailReading(where, kDamaged);
  text.resize(text.find_last_not_of('\0') + 1);
  return text;
}

double Hdf5File::ReadNumber(const std::string& owner, const std::string& name) const {
  const std::string where = owner + " attribute " + name;
  if (!HasAttribute(owner, name)) FailReading(where, "missing; expected a number");
  const Hdf5Handle attribute = OpenAttribute(owner, name);
  const Hdf5Handle type{H5Aget_type(attribute.id()), &H5Tclose};
  const Hdf5Handle space{H5Aget_space(attribute.id()), &H5Sclose};
  if (H5Tequal(type.id(), H5T_IEEE_F64LE) <= 0 || H5Sget_simple_extent_npoints(space.id()) != 1) {
    FailReading(where, "is not one float64; expected one");
  }
  double number;
  if (H5Aread(attribute.id(), H5T_IEEE_F64LE, &number) < 0) FailReading(where, kDamaged);
  return number;
}

}  // namespace soslam

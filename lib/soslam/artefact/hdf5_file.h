// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/traits.hpp>
#include <string>
#include <utility>
#include <vector>

#include "soslam/artefact/atomic_file.h"

namespace soslam {

using ArrayShape = std::vector<std::uint64_t>;

// Owns one identifier of the HDF5 library.
class Hdf5Handle {
 public:
  using CloseFunction = int (*)(std::int64_t);

  Hdf5Handle(std::int64_t id, CloseFunction close) : id_(id), close_(close) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_(std::exchange(other.id_, kInvalid)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() { Close(); }

  bool valid() const { return id_ >= 0; }
  std::int64_t id() const { return id_; }
  // False when the library fails to close it. Does nothing when closed already.
  bool Close();

 private:
  static constexpr std::int64_t kInvalid = -1;

  std::int64_t id_;
  CloseFunction close_;
};

// An HDF5 file, either written or read. Names are absolute: "/frames/000012/grey". Numbers are
// stored little-endian in one chunk, shuffled and deflated; no times are stored, so that the same
// calls give the same bytes. Throws SettingsError when writing fails; InputError, with the file,
// the name in it, the found and the expected value, when reading fails.
//
// The HDF5 library is not thread-safe: use it from one thread at a time, all files together. But
// any thread may read matrices and vectors: they take turns, and inflate side by side.
class Hdf5File {
 public:
  // Creates an empty file, which appears with Close(), see AtomicFile.
  static Hdf5File Create(const std::filesystem::path& path);
  static Hdf5File Open(const std::filesystem::path& path);

  // Creates a group. All writers create missing parent groups.
  void WriteGroup(const std::string& name);
  // Rows x columns, or rows x columns x 2 when the matrix has two channels. Depth 8U, 16S, 32S,
  // 32F, 64F.
  void WriteMatrix(const std::string& name, const cv::Mat& matrix);
  // One dimension; T is double, float or int.
  template <typename T>
  void WriteVector(const std::string& name, const std::vector<T>& values) {
    WriteArray(name, {values.size()}, cv::DataType<T>::depth, values.data());
  }
  // One row per vector.
  template <typename Number, int kSize>
  void WriteRows(const std::string& name,
                 const std::vector<Eigen::Matrix<Number, kSize, 1>>& vectors) {
    WriteArray(name, {vectors.size(), kSize}, cv::DataType<Number>::depth, vectors.data());
  }
  // Attributes of the group or data set `owner`, which exists. A text has no '\0'.
  void WriteText(const std::string& owner, const std::string& name, const std::string& text);
  void WriteNumber(const std::string& owner, const std::string& name, double number);
  // Finishes writing. Errors also as AtomicFile::Commit.
  void Close();

  bool Has(const std::string& name) const;
  bool HasAttribute(const std::string& owner, const std::string& name) const;
  // The names in a group, sorted.
  std::vector<std::string> Children(const std::string& group) const;
  // A matrix of this OpenCV type and size; kAny if a size is not known.
  cv::Mat ReadMatrix(const std::string& name, int type, int rows = kAny, int columns = kAny) const;
  template <typename T>
  std::vector<T> ReadVector(const std::string& name, int size = kAny) const {
    std::vector<T> values;
    ReadArray(name, cv::DataType<T>::depth, {size}, [&](const ArrayShape& shape) {
      values.resize(shape[0]);
      return values.data();
    });
    return values;
  }
  template <typename Vector>
  std::vector<Vector> ReadRows(const std::string& name, int rows = kAny) const {
    std::vector<Vector> vectors;
    ReadArray(name, cv::DataType<typename Vector::Scalar>::depth, {rows, Vector::SizeAtCompileTime},
              [&](const ArrayShape& shape) {
                vectors.resize(shape[0]);
                return vectors.data();
              });
    return vectors;
  }
  std::string ReadText(const std::string& owner, const std::string& name) const;
  double ReadNumber(const std::string& owner, const std::string& name) const;

  // For readers that do not know the layout. RequireWalkable throws InputError unless a walk
  // through all groups terminates soon: groups may contain each other or be nested without end.
  void RequireWalkable() const;
  bool IsGroup(const std::string& name) const;
  std::vector<std::string> Attributes(const std::string& owner) const;  // sorted
  bool IsText(const std::string& owner, const std::string& attribute) const;
  // A data set of any of the types above, in row-major order.
  struct Numbers {
    ArrayShape shape;
    std::vector<double> values;
  };
  Numbers ReadNumbers(const std::string& name) const;

  const std::filesystem::path& path() const { return path_; }

  static constexpr int kAny = -1;

 private:
  Hdf5File(std::filesystem::path path, std::int64_t id);

  void WriteAttribute(const std::string& owner, const std::string& name, std::int64_t type,
                      const void* value);
  Hdf5Handle OpenAttribute(const std::string& owner, const std::string& name) const;
  std::uint64_t Size() const;  // size of the file, bytes
  // Shape of a data set. Throws if it has too many values.
  ArrayShape ReadShape(const std::string& name, const Hdf5Handle& data_set) const;

  void WriteArray(const std::string& name, const ArrayShape& shape, int depth, const void* values);
  // Reads into the memory that `allocate` returns for the shape that is found. Throws before that
  // if shape or element type differ from the expected ones, or the stored bytes cannot hold so many
  // values.
  void ReadArray(const std::string& name, int depth, const std::vector<int>& expected,
                 const std::function<void*(const ArrayShape&)>& allocate) const;

  [[noreturn]] void FailWriting(const std::string& name) const;
  [[noreturn]] void FailReading(const std::string& name, const std::string& problem) const;

  std::filesystem::path path_;
  std::unique_ptr<AtomicFile> atomic_;  // while writing
  Hdf5Handle file_;
};

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "base/hash.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <vector>

#include "base/error.h"

namespace soslam {
namespace {

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    Require(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void Update(const char* bytes, size_t count) {
    Require(EVP_DigestUpdate(context_.get(), bytes, count) == 1);
  }
  std::string HexDigest() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
    unsigned int size = 0;
    Require(EVP_DigestFinal_ex(context_.get(), digest.data(), &size) == 1);
    return fmt::format("{:02x}", fmt::join(digest.begin(), digest.begin() + size, ""));
  }

 private:
  static void Require(bool done) {
    if (!done) throw std::runtime_error("OpenSSL cannot compute SHA-256");
  }

  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string Sha256OfText(std::string_view text) {
  Sha256 sha256;
  sha256.Update(text.data(), text.size());
  return sha256.HexDigest();
}

std::string Sha256OfFile(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  Sha256 sha256;
  std::vector<char> buffer(1 << 16);
  while (stream) {
    stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    sha256.Update(buffer.data(), static_cast<size_t>(stream.gcount()));
  }
  // Reading ends at the end of the file, or else it failed: a missing file, a folder, a bad disk.
  if (!stream.eof()) throw InputError(path.string() + ": cannot be read; expected a file");
  return sha256.HexDigest();
}

std::string Base64(std::string_view bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');  // EVP appends a zero byte
  const int size = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                   reinterpret_cast<const unsigned char*>(bytes.data()),
                                   static_cast<int>(bytes.size()));
  text.resize(static_cast<size_t>(size));
  return text;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace soslam {

// An HTTP server on this machine that gives files from memory, as servers do and as they fail.
class HttpServer {
 public:
  HttpServer() {
    socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto* any = reinterpret_cast<sockaddr*>(&address);
    socklen_t size = sizeof(address);
    if (::bind(socket_, any, size) != 0 || ::listen(socket_, 8) != 0 ||
        ::getsockname(socket_, any, &size) != 0) {
      throw std::runtime_error("cannot listen on this machine");
    }
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { Serve(); });
  }
  ~HttpServer() {
    ::shutdown(socket_, SHUT_RDWR);
    thread_.join();
    ::close(socket_);
  }
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  std::string Address() const { return fmt::format("http://127.0.0.1:{}", port_); }
  // Gives a file at a path, as /a/b, from now on.
  void Give(const std::string& path, const std::string& bytes) {
    Locked([&] { files_[path] = bytes; });
  }
  // The connection ends after this many bytes of a file.
  void EndAfter(size_t bytes) {
    Locked([&] { end_after_ = bytes; });
  }
  // Parts of files are not given.
  void WholeFilesOnly() {
    Locked([&] { whole_only_ = true; });
  }
  // What was asked for: "/file", or "/file from 10".
  std::vector<std::string> Requests() {
    std::vector<std::string> requests;
    Locked([&] { requests = requests_; });
    return requests;
  }

 private:
  template <typename Action>
  void Locked(const Action& action) {
    const std::lock_guard lock(mutex_);
    action();
  }
  void Serve() {
    for (int peer; (peer = ::accept(socket_, nullptr, nullptr)) >= 0; ::close(peer)) {
      std::string request;
      char bytes[4096];
      for (ssize_t count; request.find("\r\n\r\n") == request.npos &&
                          (count = ::recv(peer, bytes, sizeof(bytes), 0)) > 0;) {
        request.append(bytes, static_cast<size_t>(count));
      }
      std::string answer;
      Locked([&] { answer = Answer(request); });
      ::send(peer, answer.data(), answer.size(), MSG_NOSIGNAL);
    }
  }
  std::string Answer(const std::string& request) {
    const size_t path = request.find('/');
    const std::string name = request.substr(path, request.find(' ', path) - path);
    const size_t range = request.find("Range: bytes=");
    const size_t from = range == request.npos ? 0 : std::stoul(request.substr(range + 13));
    requests_.push_back(from == 0 ? name : fmt::format("{} from {}", name, from));
    const auto file = files_.find(name);
    if (file == files_.end()) return Head("404 Not Found", 0);
    const size_t size = file->second.size();
    if (from == 0 || whole_only_) {
      return Head("200 OK", size) + file->second.substr(0, end_after_);
    }
    if (from >= size) return Head("416 Range Not Satisfiable", 0);
    const std::string part =
        fmt::format("206 Partial Content\r\nContent-Range: bytes {}-{}/{}", from, size - 1, size);
    return Head(part, size - from) + file->second.substr(from, end_after_);
  }
  static std::string Head(const std::string& status, size_t bytes) {
    return fmt::format("HTTP/1.1 {}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n", status,
                       bytes);
  }

  std::map<std::string, std::string> files_;  // by path
  std::mutex mutex_;
  size_t end_after_ = std::string::npos;
  bool whole_only_ = false;
  std::vector<std::string> requests_;
  int socket_ = -1;
  int port_ = 0;
  std::thread thread_;
};

}  // namespace soslam

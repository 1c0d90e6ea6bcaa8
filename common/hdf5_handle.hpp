// HDF5 objects that close themselves and calls that throw; only for the files of results.
#pragma once

#include <hdf5.h>

#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

namespace kerf::hdf5 {

/// The right to call HDF5, which one thread at a time may do. Keeps it from printing its own stack
/// of errors; ours are exceptions. To be made before the first handle of a scope.
class Library {
public:
  Library() : lock_(mutex()) { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::lock_guard<std::mutex> lock_;
};

/// An identifier with the call that closes it.
class Handle {
public:
  /// @throws std::runtime_error when the identifier says that a call failed
  Handle(hid_t id, herr_t (*end)(hid_t), const std::string& what) : id_(id), close_(end) {
    if (id < 0)
      throw std::runtime_error(what);
  }
  ~Handle() {
    if (id_ >= 0)
      close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;

  operator hid_t() const { return id_; }

  /// Closes now; for a file this is when the last of it is written.
  /// @throws std::runtime_error when that fails
  void close(const std::string& what) {
    if (close_(std::exchange(id_, -1)) < 0)
      throw std::runtime_error(what);
  }

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// @throws std::runtime_error when the result says that a call failed
inline void check(herr_t result, const std::string& what) {
  if (result < 0)
    throw std::runtime_error(what);
}

} // namespace kerf::hdf5

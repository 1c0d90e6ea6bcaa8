// Transport "shm": a memfd of sealed size, inherited or opened through /proc. It has no name in
// any file system, so there is nothing to clean up after any death.
#include "coupler/channel/memory_channel.hpp"

#include <cerrno>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace kerf::coupler {
namespace {

constexpr int all_seals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;

[[noreturn]] void throw_system_error(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

std::shared_ptr<std::byte> map(int descriptor, std::size_t bytes) {
  void* memory =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, descriptor, 0);
  if (memory == MAP_FAILED)
    throw_system_error(fmt::format("cannot map {} bytes of shared memory", bytes));
  return {static_cast<std::byte*>(memory), [bytes](std::byte* start) { munmap(start, bytes); }};
}

std::unique_ptr<Channel> create(ChannelAddress& address) {
  const int descriptor = address.descriptor;
  if (descriptor < 0)
    throw std::invalid_argument("shared memory needs a descriptor of create_segment()");
  const std::size_t bytes = segment_bytes(address.up_capacity, address.down_capacity);
  if (ftruncate(descriptor, static_cast<off_t>(bytes)) != 0)
    throw_system_error(fmt::format("cannot size the shared memory to {} bytes", bytes));
  // Takes the pages now: running out of memory later would be a SIGBUS in the middle of a step.
  if (const int error = posix_fallocate(descriptor, 0, static_cast<off_t>(bytes)); error != 0)
    throw std::system_error(error, std::generic_category(),
                            fmt::format("cannot get {} bytes of shared memory", bytes));
  if (fcntl(descriptor, F_ADD_SEALS, all_seals) != 0)
    throw_system_error("cannot seal the shared memory");
  auto memory = map(descriptor, bytes);
  prepare_segment(memory.get(), address.up_capacity, address.down_capacity);
  address.endpoint = fmt::format("/proc/{}/fd/{}", getpid(), descriptor);
  return make_memory_channel(std::move(memory), End::broker, address.up_capacity,
                             address.down_capacity);
}

/// A descriptor that is closed again only if this side has opened it.
class Segment {
public:
  explicit Segment(const ChannelAddress& address) : descriptor_(address.descriptor) {
    if (descriptor_ >= 0)
      return;
    descriptor_ = open(address.endpoint.c_str(), O_RDWR | O_CLOEXEC);
    if (descriptor_ < 0)
      throw std::invalid_argument(fmt::format("cannot open the shared memory {}: {}",
                                              address.endpoint,
                                              std::generic_category().message(errno)));
    opened_ = true;
  }
  ~Segment() {
    if (opened_)
      close(descriptor_);
  }
  Segment(const Segment&) = delete;
  Segment& operator=(const Segment&) = delete;
  int descriptor() const { return descriptor_; }

private:
  int descriptor_;
  bool opened_ = false;
};

std::unique_ptr<Channel> attach(const ChannelAddress& address) {
  const Segment segment(address);
  const std::size_t bytes = segment_bytes(address.up_capacity, address.down_capacity);
  const int seals = fcntl(segment.descriptor(), F_GET_SEALS);
  if (seals < 0 || (seals & all_seals) != all_seals)
    throw std::invalid_argument("the shared memory is not a memory file of sealed size");
  struct stat status {};
  if (fstat(segment.descriptor(), &status) != 0)
    throw_system_error("cannot look at the shared memory");
  if (static_cast<std::size_t>(status.st_size) != bytes)
    throw std::invalid_argument(
        fmt::format("the shared memory has {} bytes, not the {} agreed", status.st_size, bytes));
  return make_memory_channel(map(segment.descriptor(), bytes), End::participant,
                             address.up_capacity, address.down_capacity);
}

} // namespace

int create_segment() {
  const int descriptor = memfd_create("kerf", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (descriptor < 0)
    throw_system_error("cannot make shared memory");
  return descriptor;
}

std::unique_ptr<Channel> open_shared_memory(ChannelAddress& address, End end) {
  return end == End::broker ? create(address) : attach(address);
}

} // namespace kerf::coupler

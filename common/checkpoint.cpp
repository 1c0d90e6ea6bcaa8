#include "common/checkpoint.hpp"

#include "common/atomic_file.hpp"
#include "common/hdf5_handle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <type_traits>

namespace kerf {
namespace {

namespace fs = std::filesystem;
using hdf5::Handle;

constexpr std::uint64_t format = 1; // of the file
constexpr const char* manifest = "checkpoint.json";

template <class Number> hid_t memory_type() {
  if constexpr (std::is_same_v<Number, double>)
    return H5T_NATIVE_DOUBLE;
  else if constexpr (sizeof(Number) == 8)
    return H5T_NATIVE_UINT64;
  else
    return sizeof(Number) == 4 ? H5T_NATIVE_UINT32 : H5T_NATIVE_UINT8;
}

template <class Number> hid_t file_type() {
  if constexpr (std::is_same_v<Number, double>)
    return H5T_IEEE_F64LE;
  else if constexpr (sizeof(Number) == 8)
    return H5T_STD_U64LE;
  else
    return sizeof(Number) == 4 ? H5T_STD_U32LE : H5T_STD_U8LE;
}

/// FNV-1a over names and numbers: a file that was cut or changed has another sum.
std::uint64_t checksum(const Checkpoint& checkpoint) {
  std::uint64_t sum = 0xcbf29ce484222325u;
  const auto add = [&](std::uint64_t word) { sum = (sum ^ word) * 0x100000001b3u; };
  const auto add_text = [&](const std::string& text) {
    for (const char c : text)
      add(static_cast<unsigned char>(c));
    add(0);
  };
  add_text(checkpoint.writer);
  add(checkpoint.step);
  for (const auto& [name, array] : checkpoint.state) {
    add_text(name);
    std::visit(
        [&](const auto& numbers) {
          for (const auto number : numbers)
            if constexpr (std::is_same_v<decltype(number), const double>)
              add(std::bit_cast<std::uint64_t>(number));
            else
              add(number);
        },
        array);
  }
  return sum;
}

Handle without_times(hid_t kind) {
  Handle list(H5Pcreate(kind), H5Pclose, "cannot make an HDF5 property list");
  hdf5::check(H5Pset_obj_track_times(list, false), "cannot switch off the times of HDF5");
  return list;
}

template <class Number>
void write_array(hid_t place, const std::string& name, const std::vector<Number>& numbers) {
  const std::string what = "cannot write the data set " + name;
  const hsize_t extent[] = {numbers.size()};
  const Handle properties = without_times(H5P_DATASET_CREATE);
  const Handle space(H5Screate_simple(1, extent, nullptr), H5Sclose, what);
  const Handle set(H5Dcreate2(place, name.c_str(), file_type<Number>(), space, H5P_DEFAULT,
                              properties, H5P_DEFAULT),
                   H5Dclose, what);
  if (!numbers.empty())
    hdf5::check(H5Dwrite(set, memory_type<Number>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
                what);
}

template <class Number>
std::vector<Number> read_numbers(hid_t set, std::size_t count, const std::string& what) {
  std::vector<Number> numbers(count);
  if (count != 0)
    hdf5::check(H5Dread(set, memory_type<Number>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
                what);
  return numbers;
}

StateArray read_array(hid_t place, const std::string& name, const std::string& what) {
  const Handle set(H5Dopen2(place, name.c_str(), H5P_DEFAULT), H5Dclose, what);
  const Handle space(H5Dget_space(set), H5Sclose, what);
  const Handle type(H5Dget_type(set), H5Tclose, what);
  hsize_t extent[1] = {0};
  if (H5Sget_simple_extent_ndims(space) != 1 ||
      H5Sget_simple_extent_dims(space, extent, nullptr) < 0)
    throw std::runtime_error(what);
  if (H5Tget_class(type) == H5T_FLOAT)
    return read_numbers<double>(set, extent[0], what);
  switch (H5Tget_size(type)) {
  case 8:
    return read_numbers<std::uint64_t>(set, extent[0], what);
  case 4:
    return read_numbers<std::uint32_t>(set, extent[0], what);
  default:
    return read_numbers<std::uint8_t>(set, extent[0], what);
  }
}

std::vector<std::string> members_of(hid_t group, const std::string& what) {
  std::vector<std::string> names;
  const auto visit = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  hdf5::check(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &names), what);
  return names;
}

std::uint64_t read_number(hid_t file, const std::string& name, const std::string& what) {
  const StateArray array = read_array(file, name, what);
  const auto* numbers = std::get_if<std::vector<std::uint64_t>>(&array);
  if (numbers == nullptr || numbers->size() != 1)
    throw std::runtime_error(what);
  return numbers->front();
}

Checkpoint read(const fs::path& path, const std::string& damaged) {
  const hdf5::Library library;
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, damaged);
  if (const std::uint64_t found = read_number(file, "format", damaged); found != format)
    throw CheckpointError(fmt::format("{} is a checkpoint of format {}; this kerf reads {}",
                                      path.string(), found, format));
  Checkpoint checkpoint;
  const StateArray writer = read_array(file, "writer", damaged);
  if (const auto* text = std::get_if<std::vector<std::uint8_t>>(&writer))
    checkpoint.writer.assign(text->begin(), text->end());
  checkpoint.step = read_number(file, "step", damaged);
  const Handle group(H5Gopen2(file, "state", H5P_DEFAULT), H5Gclose, damaged);
  for (const std::string& name : members_of(group, damaged))
    checkpoint.state[name] = read_array(group, name, damaged);
  if (read_number(file, "checksum", damaged) != checksum(checkpoint))
    throw std::runtime_error(damaged);
  return checkpoint;
}

} // namespace

void write_checkpoint(const fs::path& path, const Checkpoint& checkpoint) {
  write_atomically(path, [&](const fs::path& temporary) {
    const std::string what = "cannot write " + path.string();
    const hdf5::Library library;
    const Handle properties = without_times(H5P_FILE_CREATE);
    Handle file(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, properties, H5P_DEFAULT), H5Fclose,
                what);
    write_array(file, "format", std::vector<std::uint64_t>{format});
    write_array(file, "writer",
                std::vector<std::uint8_t>(checkpoint.writer.begin(), checkpoint.writer.end()));
    write_array(file, "step", std::vector<std::uint64_t>{checkpoint.step});
    write_array(file, "checksum", std::vector<std::uint64_t>{checksum(checkpoint)});
    {
      const Handle group_properties = without_times(H5P_GROUP_CREATE);
      const Handle group(H5Gcreate2(file, "state", H5P_DEFAULT, group_properties, H5P_DEFAULT),
                         H5Gclose, what);
      for (const auto& [name, array] : checkpoint.state)
        std::visit([&](const auto& numbers) { write_array(group, name, numbers); }, array);
    }
    file.close(what);
  });
}

Checkpoint read_checkpoint(const fs::path& path, const std::string& writer) {
  if (!fs::is_regular_file(path))
    throw CheckpointError("there is no checkpoint " + path.string());
  Checkpoint checkpoint;
  try {
    checkpoint = read(path, path.string() + " is truncated, changed or no checkpoint");
  } catch (const CheckpointError&) {
    throw;
  } catch (const std::exception& error) {
    throw CheckpointError(error.what());
  }
  if (checkpoint.writer != writer)
    throw CheckpointError(fmt::format("{} was written by {}, and this is {}", path.string(),
                                      checkpoint.writer, writer));
  return checkpoint;
}

fs::path checkpoint_folder(const fs::path& run_folder, std::uint64_t step) {
  return run_folder / "checkpoints" / fmt::format("{:09}", step);
}

namespace {

/// Step of a folder by its name, complete or not.
std::vector<std::pair<std::uint64_t, fs::path>> folders(const fs::path& run_folder) {
  std::vector<std::pair<std::uint64_t, fs::path>> found;
  std::error_code none; // a run without the folder has no checkpoints
  for (const auto& entry : fs::directory_iterator(run_folder / "checkpoints", none)) {
    const std::string name = entry.path().filename().string();
    if (name.size() >= 9 && name.size() < 20 &&
        name.find_first_not_of("0123456789") == std::string::npos)
      found.emplace_back(std::stoull(name), entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// First of all it is no checkpoint any more.
void discard(const fs::path& folder) {
  fs::remove(folder / manifest);
  fs::remove_all(folder);
}

} // namespace

std::vector<std::uint64_t> list_checkpoints(const fs::path& run_folder) {
  std::vector<std::uint64_t> steps;
  for (const auto& [step, folder] : folders(run_folder))
    if (fs::is_regular_file(folder / manifest))
      steps.push_back(step);
  return steps;
}

void keep_checkpoints(const fs::path& run_folder, std::size_t count) {
  const std::vector<std::uint64_t> complete = list_checkpoints(run_folder);
  if (complete.size() <= count)
    return;
  const std::uint64_t oldest = complete[complete.size() - count];
  for (const auto& [step, folder] : folders(run_folder))
    if (step < oldest)
      discard(folder);
}

void remove_checkpoints_after(const fs::path& run_folder, std::uint64_t last) {
  for (const auto& [step, folder] : folders(run_folder))
    if (step > last)
      discard(folder);
}

} // namespace kerf

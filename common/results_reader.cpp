#include "common/hdf5_handle.hpp"
#include "common/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace kerf {
namespace {

using hdf5::Handle;

/// The names of what is in a group, in their alphabetical order.
std::vector<std::string> members_of(hid_t group, const std::string& what) {
  std::vector<std::string> names;
  const auto visit = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  hdf5::check(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &names), what);
  return names;
}

template <class Number>
std::vector<Number> read_numbers(hid_t set, hid_t type, std::size_t count,
                                 const std::string& what) {
  std::vector<Number> numbers(count);
  if (count != 0)
    hdf5::check(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), what);
  return numbers;
}

Array read_array(hid_t file, const std::string& name, const std::string& what) {
  const Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, what);
  const Handle space(H5Dget_space(set), H5Sclose, what);
  const Handle type(H5Dget_type(set), H5Tclose, what);
  hsize_t extent[2] = {1, 1};
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0 || rank > 2 || H5Sget_simple_extent_dims(space, extent, nullptr) < 0)
    throw std::runtime_error(what);
  Array array;
  array.rows = extent[0];
  array.columns = extent[1];
  const std::size_t count = array.rows * array.columns;
  if (H5Tget_class(type) == H5T_FLOAT)
    array.data = read_numbers<double>(set, H5T_NATIVE_DOUBLE, count, what);
  else
    array.data = read_numbers<std::int64_t>(set, H5T_NATIVE_INT64, count, what);
  return array;
}

} // namespace

const std::vector<double>& Array::reals() const {
  if (const auto* numbers = std::get_if<std::vector<double>>(&data))
    return *numbers;
  throw std::invalid_argument("the array has integers, not real numbers");
}

const std::vector<std::int64_t>& Array::integers() const {
  if (const auto* numbers = std::get_if<std::vector<std::int64_t>>(&data))
    return *numbers;
  throw std::invalid_argument("the array has real numbers, not integers");
}

const Array& Frame::at(const std::string& name) const {
  if (const auto found = arrays.find(name); found != arrays.end())
    return found->second;
  std::string names;
  for (const auto& [other, array] : arrays)
    names += (names.empty() ? "" : ", ") + other;
  throw std::invalid_argument(fmt::format("there is no array \"{}\"; there are {}", name, names));
}

Frame read_frame(const std::filesystem::path& path) {
  const std::string what = path.string() + " is missing or is not a frame";
  const hdf5::Library library;
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, what);
  Frame frame;
  for (const std::string& name : members_of(file, what)) {
    if (name == "step" || name == "time") {
      frame.arrays[name] = read_array(file, name, what);
      continue;
    }
    const Handle group(H5Gopen2(file, name.c_str(), H5P_DEFAULT), H5Gclose, what);
    for (const std::string& field : members_of(group, what))
      frame.arrays[name + "/" + field] = read_array(group, field, what);
  }
  if (!frame.has("step") || !frame.has("time") || frame.at("step").rows != 1 ||
      frame.at("time").rows != 1)
    throw std::runtime_error(what);
  frame.step = static_cast<std::uint64_t>(frame.at("step").integers().front());
  frame.time = frame.at("time").reals().front();
  frame.arrays.erase("step");
  frame.arrays.erase("time");
  return frame;
}

std::vector<FrameFile> list_frames(const std::filesystem::path& run_folder,
                                   std::string_view participant) {
  const std::string prefix = std::string(participant) + "_", suffix = ".h5";
  std::vector<FrameFile> frames;
  std::error_code none; // a folder that is not there has no frames
  for (const auto& entry : std::filesystem::directory_iterator(run_folder / "frames", none)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix) || !name.ends_with(suffix) ||
        name.size() <= prefix.size() + suffix.size())
      continue;
    const std::string step =
        name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
    if (step.size() >= 9 && step.size() < 20 &&
        step.find_first_not_of("0123456789") == std::string::npos)
      frames.push_back({std::stoull(step), entry.path()});
  }
  std::sort(frames.begin(), frames.end(),
            [](const FrameFile& a, const FrameFile& b) { return a.step < b.step; });
  return frames;
}

} // namespace kerf

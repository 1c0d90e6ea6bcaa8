// Control messages on the wire: a JSON header, then raw arrays.
#include "coupler/channel/control.hpp"

#include "coupler/protocol/frame.hpp"

#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

namespace kerf::coupler {
namespace {

using nlohmann::json;
static_assert(std::endian::native == std::endian::little, "the wire is little-endian");

constexpr std::size_t largest_header = std::size_t{64} << 20; // bytes of JSON text

constexpr const char* type_name(double /*value*/) {
  return "f64";
}
constexpr const char* type_name(std::int64_t /*value*/) {
  return "i64";
}
constexpr const char* type_name(std::uint32_t /*value*/) {
  return "u32";
}

/// Number of values of a shape, or nothing when it does not fit 64 bits.
std::optional<std::uint64_t> product(const std::vector<std::uint64_t>& shape) {
  std::uint64_t size = 1;
  for (const std::uint64_t extent : shape)
    if (__builtin_mul_overflow(size, extent, &size))
      return std::nullopt;
  return size;
}

template <class Value>
std::vector<Value> values_of(const std::string& bytes, std::uint64_t size, const std::string& name,
                             const std::string& shape) {
  if (size > std::numeric_limits<std::size_t>::max() / sizeof(Value) ||
      bytes.size() != size * sizeof(Value))
    throw ProtocolError(fmt::format("the array \"{}\" of shape {} and type {} has {} bytes", name,
                                    shape, type_name(Value{}), bytes.size()));
  std::vector<Value> values(size);
  if (size > 0)
    std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

NamedArray decode_array(const json& header, const std::string& bytes) {
  NamedArray array;
  array.name = header.at("name").get<std::string>();
  const json& shape = header.at("shape");
  if (!shape.is_array() || shape.size() > 8)
    throw ProtocolError(fmt::format("the shape of the array \"{}\" is no list", array.name));
  for (const json& extent : shape) {
    if (!extent.is_number_unsigned())
      throw ProtocolError(
          fmt::format("the array \"{}\" has the shape {}", array.name, shape.dump()));
    array.shape.push_back(extent.get<std::uint64_t>());
  }
  const auto size = product(array.shape);
  if (!size)
    throw ProtocolError(fmt::format("the array \"{}\" has the shape {}, which no machine can hold",
                                    array.name, shape.dump()));
  const auto type = header.at("type").get<std::string>();
  if (type == "f64")
    array.values = values_of<double>(bytes, *size, array.name, shape.dump());
  else if (type == "i64")
    array.values = values_of<std::int64_t>(bytes, *size, array.name, shape.dump());
  else if (type == "u32")
    array.values = values_of<std::uint32_t>(bytes, *size, array.name, shape.dump());
  else
    throw ProtocolError(
        fmt::format("the array \"{}\" has the type \"{}\": f64, i64 or u32", array.name, type));
  return array;
}

/// "stop" keeps its meaning in every version, so that a refusal can be read by everybody.
void check_version(const json& header, const std::string& type) {
  const auto version = header.at("kerf").get<std::int64_t>();
  if (version != protocol_version && type != message::stop)
    throw ProtocolError(
        fmt::format("the other side speaks version {} of the protocol, this program "
                    "version {}: use programs of the same kerf",
                    version, protocol_version));
}

Message decode_checked(const std::vector<std::string>& parts) {
  const json header = json::parse(parts.front());
  Message message;
  message.type = header.at("type").get<std::string>();
  check_version(header, message.type);
  const json& body = header.at("body");
  if (!body.is_object())
    throw ProtocolError(fmt::format("the body of the message \"{}\" is no object", message.type));
  message.body = body.dump();
  const json& arrays = header.at("arrays");
  if (!arrays.is_array() || arrays.size() + 1 != parts.size())
    throw ProtocolError(fmt::format("the message \"{}\" announces {} arrays and brings {}",
                                    message.type, arrays.size(), parts.size() - 1));
  std::set<std::string> names;
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    message.arrays.push_back(decode_array(arrays[i], parts[i + 1]));
    if (!names.insert(message.arrays.back().name).second)
      throw ProtocolError(fmt::format("the message \"{}\" has two arrays \"{}\"", message.type,
                                      message.arrays.back().name));
  }
  return message;
}

} // namespace

std::vector<std::string> encode(const Message& message) {
  std::vector<std::string> parts(1);
  json arrays = json::array();
  for (const NamedArray& array : message.arrays)
    std::visit(
        [&](const auto& values) {
          if (product(array.shape) != values.size())
            throw std::invalid_argument(fmt::format(
                "the shape of \"{}\" does not fit its {} values", array.name, values.size()));
          using Value = typename std::decay_t<decltype(values)>::value_type;
          arrays.push_back(
              {{"name", array.name}, {"type", type_name(Value{})}, {"shape", array.shape}});
          parts.emplace_back(reinterpret_cast<const char*>(values.data()),
                             values.size() * sizeof(Value));
        },
        array.values);
  const json header = {{"kerf", protocol_version},
                       {"type", message.type},
                       {"body", json::parse(message.body)},
                       {"arrays", std::move(arrays)}};
  // A sentence about an error may quote a file that is not UTF-8.
  parts[0] = header.dump(-1, ' ', false, json::error_handler_t::replace);
  return parts;
}

Message decode(const std::vector<std::string>& parts) {
  if (parts.empty())
    throw ProtocolError("an empty message came");
  if (parts.front().size() > largest_header)
    throw ProtocolError(fmt::format("a message came whose header has {} bytes", parts[0].size()));
  try {
    return decode_checked(parts);
  } catch (const json::exception& error) {
    throw ProtocolError(fmt::format("a message came that cannot be read: {}", error.what()));
  }
}

} // namespace kerf::coupler

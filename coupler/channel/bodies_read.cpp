// How the bodies of control messages are read, believing nothing. bodies.cpp writes them.
#include "coupler/channel/bodies.hpp"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kerf::coupler {
namespace {

using nlohmann::json;

/// The body and the arrays of one message; every access names what is wrong.
class Reader {
public:
  Reader(const Message& message, const char* type) : message_(message) {
    if (message.type != type)
      throw ProtocolError(
          fmt::format("a message \"{}\" came instead of \"{}\"", message.type, type));
    body_ = json::parse(message.body, nullptr, false);
    if (!body_.is_object())
      fail("its body is no JSON object");
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw ProtocolError(fmt::format("in the message \"{}\": {}", message_.type, what));
  }

  const json& at(const char* key) const {
    const auto value = body_.find(key);
    if (value == body_.end())
      fail(fmt::format("{} is missing", key));
    return *value;
  }

  std::string text(const char* key) const { return text_of(at(key), key); }
  double number(const char* key) const {
    const json& value = at(key);
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      fail(fmt::format("{} is {}, not a finite number", key, value.dump()));
    return value.get<double>();
  }
  double not_negative(const char* key) const {
    const double value = number(key);
    if (value < 0.0)
      fail(fmt::format("{} = {} is negative", key, value));
    return value;
  }
  std::uint64_t count(const char* key) const { return count_of(at(key), key); }
  std::int64_t process_id(const char* key) const {
    const std::uint64_t value = count(key);
    if (value > 0x7fffffff)
      fail(fmt::format("{} = {} is no process", key, value));
    return static_cast<std::int64_t>(value);
  }
  bool flag(const char* key) const {
    const json& value = at(key);
    if (!value.is_boolean())
      fail(fmt::format("{} is {}, not true or false", key, value.dump()));
    return value.get<bool>();
  }
  std::string object(const char* key) const {
    const json& value = at(key);
    if (!value.is_object())
      fail(fmt::format("{} is no JSON object", key));
    return value.dump();
  }
  const json& list(const char* key, std::size_t most) const {
    const json& value = at(key);
    if (!value.is_array() || value.size() > most)
      fail(fmt::format("{} is no list of at most {} items", key, most));
    return value;
  }

  std::string text_of(const json& value, const std::string& key) const {
    if (!value.is_string())
      fail(fmt::format("{} is {}, not a text", key, value.dump()));
    return value.get<std::string>();
  }
  std::uint64_t count_of(const json& value, const std::string& key) const {
    if (!value.is_number_unsigned())
      fail(fmt::format("{} is {}, not a whole number from 0", key, value.dump()));
    return value.get<std::uint64_t>();
  }

  /// An array of the message, or an empty one.
  template <class Value> std::vector<Value> optional_array(const std::string& name) const {
    for (const NamedArray& array : message_.arrays)
      if (array.name == name) {
        const auto* values = std::get_if<std::vector<Value>>(&array.values);
        if (values == nullptr)
          fail(fmt::format("the array \"{}\" has another type", name));
        return *values;
      }
    return {};
  }
  template <class Value> std::vector<Value> array(const std::string& name) const {
    for (const NamedArray& array : message_.arrays)
      if (array.name == name)
        return optional_array<Value>(name);
    fail(fmt::format("the array \"{}\" is missing", name));
  }
  std::size_t num_arrays() const { return message_.arrays.size(); }

private:
  const Message& message_;
  json body_;
};

std::vector<Field> fields(const Reader& reader, const json& interface, const char* key) {
  const auto list = interface.find(key);
  if (list == interface.end() || !list->is_array() || list->size() > std::size(all_fields))
    reader.fail(fmt::format("an interface has no list {}", key));
  std::vector<Field> result;
  for (const json& item : *list) {
    const std::string text = reader.text_of(item, key);
    const auto field = field_of_name(text);
    if (!field)
      reader.fail(fmt::format("{} names the unknown field \"{}\"", key, text));
    result.push_back(*field);
  }
  return result;
}

} // namespace

template <> Hello from_message<Hello>(const Message& message) {
  const Reader reader(message, message::hello);
  Hello body;
  const std::uint64_t protocol = reader.count("protocol");
  if (protocol != protocol_version)
    reader.fail(
        fmt::format("it speaks version {} of the protocol, not {}", protocol, protocol_version));
  body.name = reader.text("name");
  body.token = reader.text("token");
  body.pid = reader.process_id("pid");
  body.program = reader.text("program");
  return body;
}

template <> Assignment from_message<Assignment>(const Message& message) {
  const Reader reader(message, message::assignment);
  Assignment body;
  body.name = reader.text("name");
  body.settings = reader.object("settings");
  body.case_settings = reader.object("case");
  body.run_folder = reader.text("run_folder");
  body.plan_only = reader.flag("plan_only");
  body.restart = reader.text("restart");
  body.broker_pid = reader.process_id("broker_pid");
  return body;
}

template <> Declaration from_message<Declaration>(const Message& message) {
  const Reader reader(message, message::declaration);
  Declaration body;
  const std::uint64_t dimension = reader.count("dimension");
  const std::uint64_t nodes = reader.count("nodes_per_element");
  if (dimension > 3 || nodes > 8)
    reader.fail(fmt::format("dimension {} with {} nodes per element", dimension, nodes));
  body.dimension = static_cast<int>(dimension);
  body.nodes_per_element = static_cast<int>(nodes);
  body.ids = reader.array<std::int64_t>("ids");
  body.positions = reader.array<double>("positions");
  body.radii = reader.optional_array<double>("radii");
  body.stiffness = reader.optional_array<double>("stiffness");
  body.elements = reader.optional_array<std::uint32_t>("elements");
  const json& tags = reader.list("boundary", reader.num_arrays());
  for (std::size_t i = 0; i < tags.size(); ++i)
    body.boundary[reader.text_of(tags[i], "boundary")] =
        reader.array<std::uint32_t>(fmt::format("boundary/{}", i));
  body.memory_estimate = reader.not_negative("memory_estimate");
  body.has_checkpoints = reader.flag("has_checkpoints");
  body.has_stages = reader.flag("has_stages");
  if (const std::string fault = fault_in(body); !fault.empty())
    reader.fail(fault);
  return body;
}

template <> Plan from_message<Plan>(const Message& message) {
  const Reader reader(message, message::plan);
  Plan body;
  body.weights = reader.optional_array<double>("weights");
  const json& interfaces = reader.list("interfaces", reader.num_arrays());
  for (std::size_t i = 0; i < interfaces.size(); ++i) {
    if (!interfaces[i].is_object() || !interfaces[i].contains("coupling"))
      reader.fail("an interface names no coupling");
    body.interfaces.push_back({reader.text_of(interfaces[i]["coupling"], "coupling"),
                               reader.array<std::uint32_t>(fmt::format("points/{}", i)),
                               reader.optional_array<double>(fmt::format("stiffness/{}", i)),
                               fields(reader, interfaces[i], "motion"),
                               fields(reader, interfaces[i], "forces")});
  }
  body.needs_own_forces = reader.flag("needs_own_forces");
  return body;
}

template <> Limits from_message<Limits>(const Message& message) {
  const Reader reader(message, message::limits);
  Limits body;
  const std::uint64_t interfaces = reader.count("interfaces");
  if (interfaces > reader.num_arrays())
    reader.fail(fmt::format("it has {} interfaces and {} arrays", interfaces, reader.num_arrays()));
  for (std::uint64_t i = 0; i < interfaces; ++i) {
    body.inverse_mass.push_back(reader.array<double>(fmt::format("inverse_mass/{}", i)));
    body.omega2.push_back(reader.array<double>(fmt::format("omega2/{}", i)));
  }
  body.largest_omega2 = reader.not_negative("largest_omega2");
  body.limited_by = reader.text("limited_by");
  return body;
}

namespace {

/// @throws ProtocolError unless they ascend
std::vector<std::uint64_t> read_ends(const Reader& reader) {
  std::vector<std::uint64_t> ends;
  for (const json& item : reader.list("ends", 100'000)) {
    ends.push_back(reader.count_of(item, "ends"));
    if (ends.size() > 1 && ends.back() < ends[ends.size() - 2])
      reader.fail("the ends of stages do not ascend");
  }
  return ends;
}

} // namespace

template <> Schedule from_message<Schedule>(const Message& message) {
  const Reader reader(message, message::schedule);
  Schedule body;
  body.time_step = reader.not_negative("time_step");
  body.steps = reader.count("steps");
  body.history_every = reader.count("history_every");
  body.frame_every = reader.count("frame_every");
  body.ends = read_ends(reader);
  body.first_step = reader.count("first_step");
  body.checkpoint_every = reader.count("checkpoint_every");
  if (body.history_every == 0 || (body.steps > 0 && body.time_step == 0.0))
    reader.fail(fmt::format("{} steps of {} s with a history row every {} steps", body.steps,
                            body.time_step, body.history_every));
  const std::string layout = reader.text("layout");
  const auto [end, error] =
      std::from_chars(layout.data(), layout.data() + layout.size(), body.layout, 16);
  if (error != std::errc{} || end != layout.data() + layout.size())
    reader.fail(fmt::format("layout is \"{}\", not a checksum", layout));
  const json& channel = reader.at("channel");
  if (channel.is_null())
    return body;
  for (const char* key : {"transport", "endpoint", "up_capacity", "down_capacity"})
    if (!channel.is_object() || !channel.contains(key))
      reader.fail(fmt::format("the channel has no {}", key));
  body.channel.transport = reader.text_of(channel["transport"], "transport");
  body.channel.endpoint = reader.text_of(channel["endpoint"], "endpoint");
  body.channel.up_capacity = reader.count_of(channel["up_capacity"], "up_capacity");
  body.channel.down_capacity = reader.count_of(channel["down_capacity"], "down_capacity");
  return body;
}

template <> Progress from_message<Progress>(const Message& message) {
  const Reader reader(message, message::progress);
  return {reader.count("step"), reader.not_negative("waiting_seconds")};
}

template <> CheckpointReport from_message<CheckpointReport>(const Message& message) {
  return {Reader(message, message::checkpoint).count("step")};
}

template <> ConditionMet from_message<ConditionMet>(const Message& message) {
  const Reader reader(message, message::condition);
  return {reader.count("step"), reader.text("name"), reader.number("value")};
}

template <> Ends from_message<Ends>(const Message& message) {
  const Reader reader(message, message::ends);
  return {reader.count("steps"), read_ends(reader)};
}

template <> Finished from_message<Finished>(const Message& message) {
  const Reader reader(message, message::finished);
  return {reader.count("steps"), reader.not_negative("compute_seconds"),
          reader.not_negative("exchange_seconds"), reader.not_negative("waiting_seconds"),
          reader.object("summary")};
}

template <> ErrorReport from_message<ErrorReport>(const Message& message) {
  const Reader reader(message, message::error);
  const std::string kind = reader.text("kind");
  if (kind != "bad_input" && kind != "failed")
    reader.fail(fmt::format("the kind \"{}\" is unknown", kind));
  return {kind == "bad_input" ? ErrorKind::bad_input : ErrorKind::failed, reader.text("key"),
          reader.text("sentence"), reader.count("step")};
}

template <> Stop from_message<Stop>(const Message& message) {
  return {Reader(message, message::stop).text("reason")};
}

} // namespace kerf::coupler

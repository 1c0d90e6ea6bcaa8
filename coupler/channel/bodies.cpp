// How the bodies of control messages become messages. bodies_read.cpp has the way back.
#include "coupler/channel/bodies.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace kerf::coupler {
namespace {

using nlohmann::json;

/// Text from outside need not be UTF-8: a path, a line of a file quoted in an error.
std::string text(const json& body) {
  return body.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// @throws std::invalid_argument
json object(const std::string& body, const char* what) {
  json parsed = json::parse(body, nullptr, false);
  if (!parsed.is_object())
    throw std::invalid_argument(fmt::format("the {} is no JSON object: {}", what, body));
  return parsed;
}

template <class Value>
NamedArray array(std::string name, const std::vector<Value>& values, std::size_t row = 1) {
  NamedArray result{std::move(name), {values.size()}, values};
  if (row > 1 && values.size() % row == 0)
    result.shape = {values.size() / row, row};
  return result;
}

json names(const std::vector<Field>& fields) {
  json list = json::array();
  for (const Field field : fields)
    list.push_back(name(field));
  return list;
}

} // namespace

Message to_message(const Hello& body) {
  return {message::hello,
          text({{"protocol", body.protocol},
                {"name", body.name},
                {"token", body.token},
                {"pid", body.pid},
                {"program", body.program}}),
          {}};
}

Message to_message(const Assignment& body) {
  return {message::assignment,
          text({{"name", body.name},
                {"settings", object(body.settings, "settings")},
                {"case", object(body.case_settings, "case")},
                {"run_folder", body.run_folder.string()},
                {"plan_only", body.plan_only},
                {"restart", body.restart.string()},
                {"broker_pid", body.broker_pid}}),
          {}};
}

Message to_message(const Declaration& body) {
  Message message{message::declaration, {}, {}};
  const auto dimension = static_cast<std::size_t>(body.dimension);
  message.arrays = {array("ids", body.ids), array("positions", body.positions, dimension)};
  if (!body.radii.empty())
    message.arrays.push_back(array("radii", body.radii));
  if (!body.stiffness.empty())
    message.arrays.push_back(array("stiffness", body.stiffness));
  if (!body.elements.empty())
    message.arrays.push_back(
        array("elements", body.elements, static_cast<std::size_t>(body.nodes_per_element)));
  json tags = json::array();
  for (const auto& [tag, faces] : body.boundary) {
    const auto row = static_cast<std::size_t>(body.nodes_per_face());
    message.arrays.push_back(array(fmt::format("boundary/{}", tags.size()), faces, row));
    tags.push_back(tag);
  }
  message.body = text({{"dimension", body.dimension},
                       {"nodes_per_element", body.nodes_per_element},
                       {"boundary", std::move(tags)},
                       {"memory_estimate", body.memory_estimate},
                       {"has_checkpoints", body.has_checkpoints},
                       {"has_stages", body.has_stages}});
  return message;
}

Message to_message(const Plan& body) {
  Message message{message::plan, {}, {}};
  if (!body.weights.empty())
    message.arrays.push_back(array("weights", body.weights));
  json interfaces = json::array();
  for (const Interface& interface : body.interfaces) {
    const std::size_t i = interfaces.size();
    message.arrays.push_back(array(fmt::format("points/{}", i), interface.points));
    if (!interface.stiffness.empty())
      message.arrays.push_back(array(fmt::format("stiffness/{}", i), interface.stiffness));
    interfaces.push_back({{"coupling", interface.coupling},
                          {"motion", names(interface.motion)},
                          {"forces", names(interface.forces)}});
  }
  message.body =
      text({{"interfaces", std::move(interfaces)}, {"needs_own_forces", body.needs_own_forces}});
  return message;
}

Message to_message(const Limits& body) {
  Message message{message::limits, {}, {}};
  for (std::size_t i = 0; i < body.inverse_mass.size(); ++i)
    message.arrays.push_back(array(fmt::format("inverse_mass/{}", i), body.inverse_mass[i]));
  for (std::size_t i = 0; i < body.omega2.size(); ++i)
    message.arrays.push_back(array(fmt::format("omega2/{}", i), body.omega2[i]));
  message.body = text({{"interfaces", body.omega2.size()},
                       {"largest_omega2", body.largest_omega2},
                       {"limited_by", body.limited_by}});
  return message;
}

Message to_message(const Schedule& body) {
  json channel; // null without an interface
  if (!body.channel.transport.empty())
    channel = {{"transport", body.channel.transport},
               {"endpoint", body.channel.endpoint},
               {"up_capacity", body.channel.up_capacity},
               {"down_capacity", body.channel.down_capacity}};
  return {message::schedule,
          text({{"time_step", body.time_step},
                {"steps", body.steps},
                {"history_every", body.history_every},
                {"frame_every", body.frame_every},
                {"ends", body.ends},
                {"first_step", body.first_step},
                {"checkpoint_every", body.checkpoint_every},
                {"layout", fmt::format("{:016x}", body.layout)}, // JSON readers may lose 64 bits
                {"channel", std::move(channel)}}),
          {}};
}

Message to_message(const Progress& body) {
  return {message::progress,
          text({{"step", body.step}, {"waiting_seconds", body.waiting_seconds}}),
          {}};
}

Message to_message(const CheckpointReport& body) {
  return {message::checkpoint, text({{"step", body.step}}), {}};
}

Message to_message(const ConditionMet& body) {
  return {message::condition,
          text({{"step", body.step}, {"name", body.name}, {"value", body.value}}),
          {}};
}

Message to_message(const Ends& body) {
  return {message::ends, text({{"steps", body.steps}, {"ends", body.ends}}), {}};
}

Message to_message(const Finished& body) {
  return {message::finished,
          text({{"steps", body.steps},
                {"compute_seconds", body.compute_seconds},
                {"exchange_seconds", body.exchange_seconds},
                {"waiting_seconds", body.waiting_seconds},
                {"summary", object(body.summary, "summary")}}),
          {}};
}

Message to_message(const ErrorReport& body) {
  return {message::error,
          text({{"kind", body.kind == ErrorKind::bad_input ? "bad_input" : "failed"},
                {"key", body.key},
                {"sentence", body.sentence},
                {"step", body.step}}),
          {}};
}

Message to_message(const Stop& body) {
  return {message::stop, text({{"reason", body.reason}}), {}};
}

} // namespace kerf::coupler

// The bodies of control messages: each survives its way over the wire, and values that cannot be
// are refused with a sentence that names them.
#include "coupler/channel/bodies.hpp"
#include "coupler/channel/control.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace kerf::coupler {
namespace {

using nlohmann::json;

template <class Body> Body over_the_wire(const Body& body) {
  return from_message<Body>(decode(encode(to_message(body))));
}

/// The reason why a message is refused, or nothing.
template <class Body> std::string refusal(const Message& message) {
  try {
    from_message<Body>(message);
  } catch (const ProtocolError& error) {
    return error.what();
  }
  return "";
}

/// A message whose body is changed at one place.
/// @param value  JSON text
template <class Body> Message with(const Body& body, const char* pointer, const char* value) {
  Message message = to_message(body);
  json changed = json::parse(message.body);
  changed[json::json_pointer(pointer)] = json::parse(value);
  message.body = changed.dump();
  return message;
}

Declaration triangle() {
  Declaration d;
  d.dimension = 2;
  d.ids = {10, 5, 7};
  d.positions = {0, 0, 1, 0, 0, 1};
  d.nodes_per_element = 3;
  d.elements = {0, 1, 2};
  d.boundary = {{"bottom", {0, 1}}, {"left \"side\"", {2, 0}}};
  d.memory_estimate = 123;
  d.has_checkpoints = true;
  return d;
}

Plan plan() {
  Plan p;
  p.weights = {1.0, 0.5, 0.05};
  p.interfaces = {{"joint", {0, 2}, {1e9, 2e9}, {Field::position, Field::velocity}, {Field::force}},
                  {"other", {1}, {}, {Field::temperature}, {Field::heat_flow, Field::moment}}};
  p.needs_own_forces = true;
  return p;
}

TEST(Bodies, of_the_handshake_survive_the_wire) {
  const Hello hello =
      over_the_wire(Hello{.name = "rock", .token = "t", .pid = 42, .program = "x 1"});
  EXPECT_EQ(hello.name, "rock");
  EXPECT_EQ(hello.token, "t");
  EXPECT_EQ(hello.pid, 42);
  EXPECT_EQ(hello.program, "x 1");

  const Assignment assignment = over_the_wire(
      Assignment{"rock", R"({"a": [1, 2]})", R"({"b": 0.1})", "/a b", true, 17, "/c d"});
  EXPECT_EQ(json::parse(assignment.settings), json::parse(R"({"a": [1, 2]})"));
  EXPECT_EQ(json::parse(assignment.case_settings)["b"], 0.1);
  EXPECT_EQ(assignment.run_folder, "/a b");
  EXPECT_TRUE(assignment.plan_only);
  EXPECT_EQ(assignment.broker_pid, 17);
  EXPECT_EQ(assignment.restart, "/c d");
}

TEST(Bodies, of_declarations_and_plans_survive_the_wire) {
  const Declaration d = over_the_wire(triangle());
  EXPECT_EQ(d.ids, triangle().ids);
  EXPECT_EQ(d.positions, triangle().positions);
  EXPECT_EQ(d.elements, triangle().elements);
  EXPECT_EQ(d.boundary, triangle().boundary);
  EXPECT_EQ(d.memory_estimate, 123.0);
  EXPECT_TRUE(d.has_checkpoints);
  EXPECT_FALSE(d.has_stages);

  const Plan p = over_the_wire(plan());
  EXPECT_EQ(p.weights, plan().weights);
  EXPECT_TRUE(p.needs_own_forces);
  ASSERT_EQ(p.interfaces.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(p.interfaces[i].coupling, plan().interfaces[i].coupling);
    EXPECT_EQ(p.interfaces[i].points, plan().interfaces[i].points);
    EXPECT_EQ(p.interfaces[i].stiffness, plan().interfaces[i].stiffness);
    EXPECT_EQ(p.interfaces[i].motion, plan().interfaces[i].motion);
    EXPECT_EQ(p.interfaces[i].forces, plan().interfaces[i].forces);
  }
  EXPECT_TRUE(over_the_wire(Plan{}).interfaces.empty());
}

TEST(Bodies, of_limits_and_schedules_survive_the_wire_to_the_last_bit) {
  const Limits limits = over_the_wire(Limits{{{0.1, 0.0}, {}}, {{1e18}, {}}, 1.0 / 3, "node 7"});
  EXPECT_EQ(limits.inverse_mass, (std::vector<std::vector<double>>{{0.1, 0.0}, {}}));
  EXPECT_EQ(limits.omega2, (std::vector<std::vector<double>>{{1e18}, {}}));
  EXPECT_EQ(limits.largest_omega2, 1.0 / 3);
  EXPECT_EQ(limits.limited_by, "node 7");

  Schedule s{.time_step = 1e-7 / 3, .steps = 1'000'000'007, .history_every = 3, .frame_every = 9};
  s.ends = {4, 4, 9};
  s.first_step = 5;
  s.checkpoint_every = 7;
  s.layout = 0xfedcba9876543210;
  s.channel = {"shm", "/proc/1/fd/3", 5, 1024, 512};
  const Schedule back = over_the_wire(s);
  EXPECT_EQ(back.time_step, s.time_step);
  EXPECT_EQ(back.steps, s.steps);
  EXPECT_EQ(back.history_every, 3u);
  EXPECT_EQ(back.frame_every, 9u);
  EXPECT_EQ(back.ends, s.ends);
  EXPECT_EQ(back.first_step, 5u);
  EXPECT_EQ(back.checkpoint_every, 7u);
  EXPECT_EQ(back.layout, s.layout);
  EXPECT_EQ(back.channel.endpoint, "/proc/1/fd/3");
  EXPECT_EQ(back.channel.up_capacity, 1024u);
  EXPECT_EQ(back.channel.descriptor, -1); // does not travel
  EXPECT_EQ(over_the_wire(Schedule{}).channel.transport, "");
}

TEST(Bodies, of_the_reports_survive_the_wire) {
  EXPECT_EQ(over_the_wire(Progress{12, 0.5}).step, 12u);
  EXPECT_EQ(over_the_wire(CheckpointReport{34}).step, 34u);
  const ConditionMet met = over_the_wire(ConditionMet{7, "at rest", 1.0 / 3});
  EXPECT_EQ(met.step, 7u);
  EXPECT_EQ(met.name, "at rest");
  EXPECT_EQ(met.value, 1.0 / 3);
  const Ends ends = over_the_wire(Ends{8, {3, 8}});
  EXPECT_EQ(ends.steps, 8u);
  EXPECT_EQ(ends.ends, (std::vector<std::uint64_t>{3, 8}));
  const Finished finished = over_the_wire(Finished{5, 0.1, 0.2, 0.3, R"({"x": 1})"});
  EXPECT_EQ(finished.steps, 5u);
  EXPECT_EQ(finished.exchange_seconds, 0.2);
  EXPECT_EQ(json::parse(finished.summary)["x"], 1);
  const auto error = over_the_wire(ErrorReport{ErrorKind::bad_input, "a.b", "no such tag", 3});
  EXPECT_EQ(error.kind, ErrorKind::bad_input);
  EXPECT_EQ(error.key, "a.b");
  EXPECT_EQ(over_the_wire(Stop{"enough"}).reason, "enough");
}

TEST(Bodies, may_quote_text_that_is_not_unicode) {
  EXPECT_NE(over_the_wire(ErrorReport{ErrorKind::failed, "", "line \"\xff\"", 0}).sentence, "");
}

TEST(Bodies, of_another_type_are_refused_by_both_names) {
  const std::string text = refusal<Plan>(to_message(Stop{"x"}));
  EXPECT_NE(text.find("\"stop\""), std::string::npos) << text;
  EXPECT_NE(text.find("\"plan\""), std::string::npos) << text;
}

TEST(Bodies, of_another_version_of_the_protocol_are_refused) {
  EXPECT_NE(refusal<Hello>(with(Hello{}, "/protocol", "2")), "");
}

TEST(Bodies, with_values_of_the_wrong_kind_are_refused) {
  EXPECT_NE(refusal<Hello>(with(Hello{}, "/name", "1")), "");
  EXPECT_NE(refusal<Hello>(with(Hello{}, "/pid", "-1")), "");
  EXPECT_NE(refusal<Assignment>(with(Assignment{"", "{}", "{}", {}}, "/settings", R"("text")")),
            "");
  EXPECT_NE(refusal<Progress>(with(Progress{}, "/step", "-1")), "");
  EXPECT_NE(refusal<Progress>(with(Progress{}, "/step", "0.5")), "");
  EXPECT_NE(refusal<Progress>(with(Progress{}, "/waiting_seconds", "null")), ""); // NaN as JSON
  EXPECT_NE(refusal<Finished>(with(Finished{}, "/summary", "1")), "");
  EXPECT_NE(refusal<ErrorReport>(with(ErrorReport{}, "/kind", R"("bored")")), "");
  EXPECT_NE(refusal<Plan>(with(plan(), "/interfaces/0/motion/0", R"("colour")")), "");
  EXPECT_NE(refusal<Plan>(with(plan(), "/interfaces/0", "1")), "");
  EXPECT_NE(refusal<Plan>(with(plan(), "/interfaces", "[1, 2, 3, 4, 5, 6, 7]")), "");
  EXPECT_NE(refusal<Limits>(with(Limits{}, "/interfaces", "1000000000000")), "");
  EXPECT_NE(refusal<Stop>({"stop", "[]", {}}), "");
}

TEST(Bodies, of_schedules_without_sense_are_refused) {
  const Schedule s{.time_step = 1e-6, .steps = 10};
  EXPECT_EQ(refusal<Schedule>(to_message(s)), "");
  EXPECT_NE(refusal<Schedule>(with(s, "/time_step", "0")), "");
  EXPECT_NE(refusal<Schedule>(with(s, "/time_step", "-1e-6")), "");
  EXPECT_NE(refusal<Schedule>(with(s, "/history_every", "0")), "");
  EXPECT_NE(refusal<Schedule>(with(s, "/ends", "[5, 4]")), "");
  EXPECT_NE(refusal<Schedule>(with(s, "/ends", "[-5]")), "");
  EXPECT_NE(refusal<Schedule>(with(s, "/layout", R"("12 apples")")), "");
  EXPECT_NE(refusal<Schedule>(with(s, "/channel", R"("shm")")), "");
  EXPECT_NE(refusal<Schedule>(with(s, "/channel", R"({"transport": "shm"})")), "");
}

TEST(Declaration, is_refused_with_the_first_fault) {
  const auto fault = [](auto change) {
    Declaration d = triangle();
    change(d);
    const std::string text = fault_in(d);
    if (!text.empty()) { // what a solver may not say, the broker does not believe either
      EXPECT_NE(refusal<Declaration>(to_message(d)), "") << text;
    }
    return text;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fault([](auto&) {}), "");
  EXPECT_EQ(fault([](auto& d) { d.dimension = 1; }), "the dimension is 1, not 2 or 3");
  EXPECT_EQ(fault([](auto& d) { d.ids[2] = 10; }), "the id 10 stands twice");
  EXPECT_EQ(fault([](auto& d) { d.ids.clear(); }), "there is no point");
  EXPECT_EQ(fault([](auto& d) { d.positions.pop_back(); }), "positions has 5 values, not 6");
  EXPECT_EQ(fault([&](auto& d) { d.positions[3] = nan; }), "positions[3] is nan");
  EXPECT_EQ(fault([](auto& d) { d.radii = {1, 1, 0}; }), "radii[2] is 0");
  EXPECT_EQ(fault([](auto& d) { d.radii = {1}; }), "radii has 1 values, not 3");
  EXPECT_EQ(fault([](auto& d) { d.stiffness = {1, -1, 1}; }), "stiffness[1] is -1");
  EXPECT_EQ(fault([](auto& d) { d.elements[1] = 3; }), "elements[1] is 3, there are 3 points");
  EXPECT_NE(fault([](auto& d) { d.elements.pop_back(); }), "");
  EXPECT_NE(fault([](auto& d) { d.nodes_per_element = 8; }), "");
  EXPECT_NE(fault([](auto& d) { d.nodes_per_element = 0; }), "");
  EXPECT_NE(fault([](auto& d) { d.boundary["x"] = {0}; }), "");
  EXPECT_NE(fault([](auto& d) { d.boundary["x"] = {0, 9}; }), "");
}

TEST(Plan, is_refused_when_it_does_not_fit_the_points) {
  EXPECT_EQ(fault_in(plan(), 3), "");
  EXPECT_NE(fault_in(plan(), 4), ""); // three weights
  Plan p = plan();
  p.weights.clear();
  EXPECT_EQ(fault_in(p, 3), "");
  p.interfaces[0].points = {0, 3};
  EXPECT_NE(fault_in(p, 3), "");
  p.interfaces[0].points = {2, 0};
  EXPECT_NE(fault_in(p, 3), "");
  p.interfaces[0].points = {0, 1, 2};
  EXPECT_NE(fault_in(p, 3), ""); // two stiffnesses
}

TEST(Limits, are_refused_when_they_do_not_fit_the_plan) {
  const Limits good{{{1, 1, 0, 1}, {2, 2}}, {{5, 6}, {7}}, 9, "node 1"};
  EXPECT_EQ(fault_in(good, plan(), 2), "");
  EXPECT_NE(fault_in(good, plan(), 3), "");
  Limits bad = good;
  bad.omega2[0][1] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(fault_in(bad, plan(), 2), "omega2 of \"joint\"[1] is inf");
  bad = good;
  bad.inverse_mass.pop_back();
  EXPECT_NE(fault_in(bad, plan(), 2), "");
  bad = good;
  bad.largest_omega2 = -1;
  EXPECT_NE(fault_in(bad, plan(), 2), "");
}

} // namespace
} // namespace kerf::coupler

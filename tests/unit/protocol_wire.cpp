// Control messages on the wire: what is sent is what is read, and nothing else is believed.
#include "coupler/channel/control.hpp"
#include "coupler/protocol/frame.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <unistd.h>
#include <zmq.hpp>

namespace kerf::coupler {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using Parts = std::vector<std::string>;

const Message sample{
    "plan",
    R"({"number":0.1,"text":"Gr\u00fc\u00dfe"})",
    {{"weights", {2, 3}, std::vector<double>{0.1, -0.0, 1e-300, 1e300, 5e-324, 3}},
     {"ids", {2}, std::vector<std::int64_t>{std::numeric_limits<std::int64_t>::min(), 7}},
     {"points", {0, 4}, std::vector<std::uint32_t>{}}}};

TEST(Wire, gives_back_what_was_sent_to_the_last_bit) {
  const Message back = decode(encode(sample));
  EXPECT_EQ(back.type, sample.type);
  EXPECT_EQ(json::parse(back.body), json::parse(sample.body));
  ASSERT_EQ(back.arrays.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back.arrays[i].name, sample.arrays[i].name);
    EXPECT_EQ(back.arrays[i].shape, sample.arrays[i].shape);
    EXPECT_EQ(back.arrays[i].values, sample.arrays[i].values);
  }
}

TEST(Wire, is_a_json_header_and_little_endian_numbers) {
  const Parts parts = encode({"limits", "{}", {{"a", {1}, std::vector<std::uint32_t>{258}}}});
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(json::parse(parts[0]), json::parse(R"({"kerf": 1, "type": "limits", "body": {},
                            "arrays": [{"name": "a", "type": "u32", "shape": [1]}]})"));
  EXPECT_EQ(parts[1], std::string("\x02\x01\x00\x00", 4));
}

TEST(Wire, refuses_to_send_an_array_whose_shape_is_not_its_size) {
  EXPECT_THROW(encode({"plan", "{}", {{"a", {2, 2}, std::vector<double>(3)}}}),
               std::invalid_argument);
}

/// The parts of a message with one array, whose header is then changed.
/// @param value  JSON text
Parts with(const char* pointer, const std::string& value) {
  Parts parts = encode({"plan", "{}", {{"a", {2}, std::vector<double>{1, 2}}}});
  json header = json::parse(parts[0]);
  header[json::json_pointer(pointer)] = json::parse(value);
  parts[0] = header.dump();
  return parts;
}

std::string refusal(const Parts& parts) {
  try {
    decode(parts);
  } catch (const ProtocolError& error) {
    return error.what();
  }
  return "";
}

TEST(Wire, refuses_another_version_by_name) {
  const std::string text = refusal(with("/kerf", "99"));
  EXPECT_NE(text.find("version 99"), std::string::npos) << text;
  EXPECT_NE(text.find("version 1"), std::string::npos) << text;
}

TEST(Wire, reads_a_stop_of_any_version) {
  Parts parts = encode({"stop", R"({"reason": "too old"})", {}});
  json header = json::parse(parts[0]);
  header["kerf"] = 99;
  EXPECT_EQ(decode({header.dump()}).type, "stop");
}

TEST(Wire, refuses_headers_that_are_not_as_agreed) {
  EXPECT_NE(refusal({}), "");
  EXPECT_NE(refusal({""}), "");
  EXPECT_NE(refusal({"{"}), "");
  EXPECT_NE(refusal({"[]"}), "");
  EXPECT_NE(refusal({"{}"}), "");
  EXPECT_NE(refusal({"\xff\xfe"}), "");
  EXPECT_NE(refusal({std::string(100'000, '[')}), "");
  EXPECT_NE(refusal(with("/kerf", R"("1")")), "");
  EXPECT_NE(refusal(with("/type", "3")), "");
  EXPECT_NE(refusal(with("/body", "[]")), "");
  EXPECT_NE(refusal(with("/arrays", "3")), "");
  EXPECT_NE(refusal(with("/arrays/0/type", R"("f32")")), "");
  EXPECT_NE(refusal(with("/arrays/0/name", "null")), "");
}

TEST(Wire, refuses_shapes_that_do_not_fit_the_bytes) {
  for (const char* shape : {"[1]", "[3]", "[2, 2]", "[0]", "[-2]", "[2.0]", "[\"2\"]", "2", "null",
                            "[1, 1, 1, 1, 1, 1, 1, 1, 2]"})
    EXPECT_NE(refusal(with("/arrays/0/shape", shape)), "") << shape;
}

// 2^62 * 4 * 8 bytes is 0 in 64 bits; nothing of that size may be taken, nor wrap around.
TEST(Wire, refuses_huge_shapes_without_taking_memory) {
  for (const std::string shape : {"[4611686018427387904]", "[4611686018427387904, 4]",
                                  "[4611686018427387904, 4611686018427387904]",
                                  "[4611686018427387904, 8, 2]", "[18446744073709551616]"})
    EXPECT_NE(refusal(with("/arrays/0/shape", shape)), "") << shape;
}

TEST(Wire, refuses_missing_and_superfluous_arrays) {
  Parts parts = encode(sample);
  parts.pop_back();
  EXPECT_NE(refusal(parts), "");
  parts = encode(sample);
  parts.emplace_back("more");
  EXPECT_NE(refusal(parts), "");
  parts = encode(sample);
  parts[1].pop_back();
  EXPECT_NE(refusal(parts), "");
  EXPECT_NE(
      refusal(encode({"plan",
                      "{}",
                      {{"a", {1}, std::vector<double>(1)}, {"a", {1}, std::vector<double>(1)}}})),
      "");
}

// Every truncation of a header is refused, and none of them crashes.
TEST(Wire, refuses_every_truncated_header) {
  const Parts parts = encode(sample);
  for (std::size_t bytes = 0; bytes < parts[0].size(); ++bytes) {
    Parts cut = parts;
    cut[0].resize(bytes);
    EXPECT_NE(refusal(cut), "") << bytes;
  }
}

std::string unique_endpoint() {
  static int count = 0;
  return fmt::format("ipc://@kerf-test-wire-{}-{}", getpid(), ++count);
}

TEST(Control, carries_messages_between_the_broker_and_several_participants) {
  ControlServer server(unique_endpoint());
  ControlClient one(server.endpoint()), two(server.endpoint());
  one.send({"hello", R"({"name": "one"})", {}});
  two.send({"hello", R"({"name": "two"})", sample.arrays});
  for (int i = 0; i < 2; ++i) {
    const auto incoming = server.receive(5s);
    ASSERT_TRUE(incoming);
    server.send(incoming->peer, {"assignment", incoming->message.body, incoming->message.arrays});
  }
  const auto answer_one = one.receive(5s), answer_two = two.receive(5s);
  ASSERT_TRUE(answer_one && answer_two);
  EXPECT_EQ(json::parse(answer_one->body)["name"], "one");
  EXPECT_EQ(json::parse(answer_two->body)["name"], "two");
  EXPECT_EQ(answer_two->arrays.size(), 3u);
  EXPECT_FALSE(server.receive(1ms));
  EXPECT_FALSE(one.receive(0ms));
}

TEST(Control, tells_who_sends_nonsense_to_stop_and_serves_the_others) {
  ControlServer server(unique_endpoint());
  zmq::context_t context;
  zmq::socket_t stranger(context, zmq::socket_type::dealer);
  stranger.set(zmq::sockopt::linger, 0);
  stranger.connect(server.endpoint());
  stranger.send(zmq::str_buffer("GET / HTTP/1.1"), zmq::send_flags::none);
  EXPECT_THROW(server.receive(5s), ProtocolError);
  zmq::message_t answer;
  ASSERT_TRUE(stranger.recv(answer));
  EXPECT_EQ(json::parse(answer.to_string())["type"], "stop");

  for (int i = 0; i < 20'000; ++i) // more parts than any message has
    stranger.send(zmq::str_buffer("x"), zmq::send_flags::sndmore);
  stranger.send(zmq::str_buffer("x"), zmq::send_flags::none);
  EXPECT_THROW(server.receive(5s), ProtocolError);

  ControlClient client(server.endpoint());
  client.send({"hello", "{}", {}});
  EXPECT_TRUE(server.receive(5s));
}

TEST(Control, notices_that_the_broker_is_gone) {
  auto server = std::make_unique<ControlServer>(unique_endpoint());
  ControlClient client(server->endpoint());
  client.send({"hello", "{}", {}});
  ASSERT_TRUE(server->receive(5s));
  EXPECT_FALSE(client.lost());
  server.reset();
  bool lost = false;
  for (int i = 0; i < 100 && !lost; ++i, usleep(10'000))
    lost = client.lost();
  EXPECT_TRUE(lost);
}

TEST(Control, names_an_endpoint_that_cannot_be_used) {
  EXPECT_THROW(ControlServer("nonsense"), std::system_error);
  EXPECT_THROW(ControlClient("nonsense"), std::invalid_argument);
}

} // namespace
} // namespace kerf::coupler

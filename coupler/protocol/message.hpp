// The control messages of a run: what is said before, beside and after the steps.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace kerf::coupler {

/// A named array that travels beside the text of a control message.
struct NamedArray {
  std::string name;
  std::vector<std::uint64_t> shape; // product is the size of `values`
  std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::uint32_t>> values;
};

/// A self-describing message: its type, its body as JSON text, and arrays as raw little-endian
/// numbers. On the wire: one part {"kerf": version, "type": …, "body": …, "arrays": [{"name",
/// "type": "f64" | "i64" | "u32", "shape"}]}, then one part for each array.
struct Message {
  std::string type;
  std::string body = "{}"; // JSON text
  std::vector<NamedArray> arrays;
};

/// Types of control messages, in the order of a run. P: participant, B: broker.
namespace message {
inline constexpr const char* hello = "hello";             // P: protocol, name, token, pid, program
inline constexpr const char* assignment = "assignment";   // B: settings of the case and participant
inline constexpr const char* declaration = "declaration"; // P: points, ids, particles or mesh
inline constexpr const char* plan = "plan";               // B: weights and interfaces
inline constexpr const char* limits = "limits";           // P: inverse masses, row sums, own limit
inline constexpr const char* schedule = "schedule"; // B: time step, steps, channel; the loop starts
inline constexpr const char* progress = "progress"; // P: step reached, at most every 0.1 s
inline constexpr const char* checkpoint = "checkpoint"; // P: it has one; B: write one, then stop
inline constexpr const char* condition = "condition";   // P: a stop condition is met in this step
inline constexpr const char* ends = "ends";             // B: when stages and run end now
inline constexpr const char* finished = "finished";     // P: the loop has ended, with its summary
inline constexpr const char* goodbye = "goodbye";       // B: everyone has finished
inline constexpr const char* error = "error";           // P: it cannot go on, and why
inline constexpr const char* stop = "stop";             // B: end at once, and the reason
} // namespace message

/// Why a participant or a run ended early.
enum class ErrorKind {
  bad_input, // the case cannot be used: names a key of the case (exit code 2)
  failed,    // it went wrong while running (exit code 3)
};

} // namespace kerf::coupler

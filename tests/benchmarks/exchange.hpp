// What one coupled step costs besides the work of the participants.
#pragma once

#include <nlohmann/json.hpp>

namespace kerf::benchmarks {

/// Times coupled steps of two participants through a broker, three processes, with `points`
/// interface points in 3D, and prints a table.
/// @return {"exchange_<points>": {"1": {"kerf": µs, "limit": µs, "zmq": µs, …}}}
nlohmann::json exchange(int points, int rounds);

} // namespace kerf::benchmarks

#include "common/log.hpp"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <stdexcept>
#include <vector>

namespace kerf {
namespace {

/// "warning: " and the like; nothing for ordinary lines.
class Severity : public spdlog::custom_flag_formatter {
public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& line) override {
    if (message.level < spdlog::level::warn)
      return;
    const std::string text = message.level == spdlog::level::warn ? "warning: " : "error: ";
    line.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return spdlog::details::make_unique<Severity>();
  }
};

} // namespace

void start_log(const LogSettings& settings) {
  std::vector<spdlog::sink_ptr> sinks;
  if (settings.to_stderr)
    sinks.push_back(std::make_shared<spdlog::sinks::stderr_sink_mt>());
  if (!settings.file.empty())
    try {
      sinks.push_back(
          std::make_shared<spdlog::sinks::basic_file_sink_mt>(settings.file.string(), true));
    } catch (const spdlog::spdlog_ex& error) {
      throw std::runtime_error(error.what());
    }
  auto logger = std::make_shared<spdlog::logger>(settings.name, sinks.begin(), sinks.end());
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<Severity>('*').set_pattern("[%H:%M:%S.%e] %n: %*%v");
  logger->set_formatter(std::move(formatter));
  logger->flush_on(spdlog::level::trace);
  spdlog::set_default_logger(std::move(logger));
}

} // namespace kerf

// Tells systemd how the service is (sd_notify(3)): "READY=1", "STOPPING=1", "WATCHDOG=1", "STATUS=...". Nothing where no one asked.
#pragma once
#include <string_view>

namespace caustream {

void notifySupervisor(std::string_view state);

}  // namespace caustream

// What a piece of work takes: on the clock, and of the processors, all threads of this process together.
#pragma once
#include <sys/resource.h>

#include <chrono>

namespace caustream::bench {

struct Spent {
    double seconds = 0, cpuSeconds = 0;
    Spent& operator+=(const Spent& other) {
        seconds += other.seconds, cpuSeconds += other.cpuSeconds;
        return *this;
    }
};

class Clock {
   public:
    Spent spent() const {
        return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(), processors() - cpuStart_};
    }

   private:
    // User and system.
    static double processors() {
        rusage used{};
        ::getrusage(RUSAGE_SELF, &used);
        const auto seconds = [](const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); };
        return seconds(used.ru_utime) + seconds(used.ru_stime);
    }

    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double cpuStart_ = processors();
};

}  // namespace caustream::bench

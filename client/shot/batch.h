// caustream-shot --batch: the lines of a file, drawn over several connections into a folder.
#pragma once
#include "client/shot/options.h"

namespace caustream::shot {

// Says on standard error what went wrong, and on standard output what came of it. The exit code: 0 all is there, 2 some
// lines failed, 1 it could not run or go on, 130 it was stopped.
int runBatch(const Options& options);

}  // namespace caustream::shot

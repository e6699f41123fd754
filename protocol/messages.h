// Both directions at once.
#pragma once
#include "protocol/client_messages.h"
#include "protocol/server_messages.h"

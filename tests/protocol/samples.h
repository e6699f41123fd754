// One filled-in message of every op, and the text it must have on the wire.
#pragma once
#include <string>
#include <vector>

#include "protocol/messages.h"

namespace caustream::protocol {

template <class Message>
struct MessageSample {
    Message message;
    std::string text;
};

const std::vector<MessageSample<ClientMessage>>& clientSamples();
const std::vector<MessageSample<ServerMessage>>& serverSamples();

// A state with every field away from its default.
State fullState();

}  // namespace caustream::protocol

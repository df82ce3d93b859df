#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

/// How a program ended.
struct Outcome
{
    int code = -1;
    std::string text; ///< of both streams
};

/// Runs a program of the build.
/// \param arguments as a shell takes them
inline Outcome runProgram(const std::string& program, const std::string& arguments)
{
    Outcome outcome;
    const std::string command =
        std::string(OSGVOLUMIZER_BINARY_DIR "/bin/") + program + " " + arguments + " 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    if (!pipe) return outcome;
    std::array<char, 256> buffer;
    while (std::fgets(buffer.data(), buffer.size(), pipe))
        outcome.text += buffer.data();
    const int status = pclose(pipe);
    if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
    return outcome;
}

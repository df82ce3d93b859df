#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <map>
#include <string>
#include <vector>

/// A program that runs until it ends or until this goes.
class Child
{
public:
    /// \param arguments the program and what it is told
    /// \param environment added to ours
    /// \param output receives both streams
    Child(const std::vector<std::string>& arguments,
          const std::map<std::string, std::string>& environment, const std::string& output)
    {
        _pid = fork();
        if (_pid != 0) return;
        const int file = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
        dup2(file, STDOUT_FILENO);
        dup2(file, STDERR_FILENO);
        for (const auto& [name, value] : environment)
            setenv(name.c_str(), value.c_str(), 1);
        std::vector<char*> pointers;
        for (const std::string& argument : arguments)
            pointers.push_back(const_cast<char*>(argument.c_str()));
        pointers.push_back(nullptr);
        execv(pointers[0], pointers.data());
        _exit(127);
    }
    ~Child()
    {
        if (!running()) return;
        kill(_pid, SIGTERM);
        for (int i = 0; i < 50 && running(); ++i)
            usleep(100000);
        if (!running()) return;
        kill(_pid, SIGKILL);
        waitpid(_pid, nullptr, 0);
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    bool running()
    {
        if (!_ended) _ended = _pid <= 0 || waitpid(_pid, nullptr, WNOHANG) != 0;
        return !_ended;
    }

private:
    pid_t _pid = -1;
    bool _ended = false;
};

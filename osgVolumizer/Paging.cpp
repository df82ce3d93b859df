#include "Paging.h"

#include "core/Text.h"

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>

#include <unistd.h>

namespace osgVolumizer {

namespace {

constexpr std::int64_t MEGABYTE = std::int64_t(1) << 20;
constexpr int MOST_THREADS = 64;

std::int64_t memoryOfMachine()
{
    const long pages = ::sysconf(_SC_PHYS_PAGES), bytes = ::sysconf(_SC_PAGE_SIZE);
    return pages > 0 && bytes > 0 ? std::int64_t(pages) * bytes : 1024 * MEGABYTE;
}

// Megabytes in an environment variable, or `otherwise` where that is none, or no number above 0.
std::int64_t bytesFromEnvironment(const char* name, std::int64_t otherwise)
{
    const char* text = std::getenv(name);
    if (!text || !*text) return otherwise;
    std::int64_t megabytes = 0;
    if (core::parseInteger(text, megabytes) && megabytes >= 1 && megabytes <= (1 << 30))
        return megabytes * MEGABYTE;
    reportError({ErrorCode::VALUE_INVALID,
                 std::string(name) + " is \"" + text + "\", expected megabytes, 1 or more"});
    return otherwise;
}

Status check(const PagingBudget& budget)
{
    const auto refusal = [](const std::string& text) {
        return Status(ErrorCode::VALUE_INVALID, "paging budget: " + text);
    };
    if (budget.memoryBytes < MEGABYTE || budget.textureBytes < MEGABYTE)
        return refusal(std::to_string(std::min(budget.memoryBytes, budget.textureBytes)) +
                       " bytes, expected a megabyte or more");
    if (!(budget.uploadMilliseconds > 0.0))
        return refusal(core::formatNumber(budget.uploadMilliseconds) +
                       " milliseconds, expected more than 0");
    if (budget.threads < 1 || budget.threads > MOST_THREADS)
        return refusal(std::to_string(budget.threads) + " threads, expected 1 to " +
                       std::to_string(MOST_THREADS));
    return {};
}

std::mutex mutex; // of what follows

PagingBudget& budgetInForce()
{
    static PagingBudget budget = defaultPagingBudget();
    return budget;
}

PagingCallback& callbackInForce()
{
    static auto* const callback = new PagingCallback; // viewers may outlive what is static
    return *callback;
}

} // namespace

PagingBudget defaultPagingBudget()
{
    const std::int64_t memory = std::max(memoryOfMachine(), 64 * MEGABYTE);
    PagingBudget budget;
    budget.memoryBytes = bytesFromEnvironment("OSGVOLUMIZER_MEMORY", memory / 4);
    budget.textureBytes = bytesFromEnvironment("OSGVOLUMIZER_TEXTURE_MEMORY", memory / 8);
    budget.uploadMilliseconds = 4.0;
    budget.threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()) - 1, 2, 8);
    return budget;
}

ReportedStatus setPagingBudget(const PagingBudget& budget)
{
    if (Status status = check(budget); !status.ok()) return reported(std::move(status));
    std::lock_guard<std::mutex> lock(mutex);
    budgetInForce() = budget;
    return {};
}

PagingBudget getPagingBudget()
{
    std::lock_guard<std::mutex> lock(mutex);
    return budgetInForce();
}

void setPagingCallback(PagingCallback callback)
{
    std::lock_guard<std::mutex> lock(mutex);
    callbackInForce() = std::move(callback);
}

PagingCallback getPagingCallback()
{
    std::lock_guard<std::mutex> lock(mutex);
    return callbackInForce();
}

} // namespace osgVolumizer

#include "io/spelling.hpp"

#include <algorithm>
#include <vector>

namespace talus {

std::size_t spelling_distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i)
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[a.size()][b.size()];
}

std::string nearest_spelling(std::string_view word, const std::set<std::string>& known) {
    std::string nearest;
    const std::size_t allowed = word.size() <= 3 ? 1 : std::max<std::size_t>(2, word.size() / 3);
    std::size_t least = allowed + 1;
    for (const std::string& candidate : known) {
        const std::size_t distance = spelling_distance(word, candidate);
        if (distance < least && distance < std::max(word.size(), candidate.size())) {
            least = distance;
            nearest = candidate;
        }
    }
    if (!nearest.empty()) return nearest;
    std::size_t longest = 2;  // another form of the word, such as its plural: half of it begins the same
    for (const std::string& candidate : known) {
        const auto common = static_cast<std::size_t>(
            std::mismatch(word.begin(), word.end(), candidate.begin(), candidate.end()).first - word.begin());
        if (common > longest && 2 * common >= std::max(word.size(), candidate.size())) {
            longest = common;
            nearest = candidate;
        }
    }
    return nearest;
}

}  // namespace talus

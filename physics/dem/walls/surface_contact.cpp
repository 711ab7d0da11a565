#include "physics/dem/walls/surface_contact.hpp"

#include <algorithm>
#include <cmath>

namespace talus::dem {

namespace {

constexpr double same_direction = 1e-12;

}  // namespace

void unite_smooth_contacts(std::vector<SurfaceContact>& contacts, std::size_t begin) {
    if (contacts.size() == begin + 1) {
        contacts.back().place *= contacts_of_one_part;
        return;
    }
    const auto first = contacts.begin() + static_cast<std::ptrdiff_t>(begin);
    std::stable_sort(first, contacts.end(), [](const SurfaceContact& a, const SurfaceContact& b) {
        return a.place != b.place ? a.place < b.place : a.distance < b.distance;
    });
    const double least_cosine = std::cos(one_contact_angle);
    std::size_t kept = begin;  // groups are formed in place: the mean replaces the group's nearest contact
    std::uint32_t part = 0, of_part = 0;
    for (std::size_t c = begin; c < contacts.size();) {
        if (c == begin || contacts[c].place != part) of_part = 0;
        part = contacts[c].place;
        const SurfaceContact nearest = contacts[c];
        std::size_t end = c;
        while (end < contacts.size() && contacts[end].place == part) ++end;
        const auto with_nearest = std::stable_partition(
            contacts.begin() + static_cast<std::ptrdiff_t>(c),
            contacts.begin() + static_cast<std::ptrdiff_t>(end),
            [&](const SurfaceContact& other) { return dot(other.normal, nearest.normal) > least_cosine; });
        const auto next = static_cast<std::size_t>(with_nearest - contacts.begin());
        SurfaceContact united = nearest;
        if (next > c + 1) {
            Vector3<> normals = nearest.normal;
            double weights = 1, distances = nearest.distance;
            for (std::size_t k = c; k < next; ++k) {
                const double cosine = dot(contacts[k].normal, nearest.normal);
                const double range = nearest.distance * (1 - cosine);
                if (!(range > same_direction * nearest.distance))
                    continue;  // the nearest itself, or its like
                const double weight = std::max(nearest.distance - contacts[k].distance * cosine, 0.0) / range;
                normals += weight * contacts[k].normal;
                distances += weight * contacts[k].distance;
                weights += weight;
            }
            united.normal = (1 / norm(normals)) * normals;
            united.distance = distances / weights;
        }
        united.place = part * contacts_of_one_part + std::min(of_part++, contacts_of_one_part - 1);
        contacts[kept++] = united;
        c = next;
    }
    contacts.resize(kept);
}

}  // namespace talus::dem

#pragma once
// The map of one particle, in pages that it shares with the particles it was copied with until one of them
// writes.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "slamot/core/data/Identities.h"
#include "slamot/core/data/Pose2.h"

namespace slamot {

/// Items ascend by `id` and have a `point.mean` [m]. Items that were made one after the other lie near one
/// another in the world, so a page's bounding box tells most pages off that are out of reach.
///
/// Who owns a page is told by a number: particles that were copied get new ones (`renew`), so their pages are
/// nobody's and are copied when one of them writes. Counting references would do the same but let threads
/// race.
template <class Item>
class SharedPages {
  public:
    static constexpr int page_capacity = 16;
    using Owner = std::uint64_t;

    /// Where an item is; valid until items are added or removed.
    struct Place {
        int page = 0, item = 0;
        friend bool operator==(Place a, Place b) { return a.page == b.page && a.item == b.item; }
        friend bool operator<(Place a, Place b) {
            return a.page != b.page ? a.page < b.page : a.item < b.item;
        }
    };

    /// Pages made from now on belong to `owner`, those made before to nobody.
    void renew(Owner owner) { owner_ = owner; }

    int size() const { return size_; }
    int pages() const { return static_cast<int>(pages_.size()); }
    const Item& at(Place place) const { return page(place).items[static_cast<std::size_t>(place.item)]; }
    /// Copies the page if it is shared.
    Item& write(Place place) {
        return own(static_cast<std::size_t>(place.page)).items[static_cast<std::size_t>(place.item)];
    }
    /// Says that an item written to may have moved.
    void moved(Place place) {
        Page& page = own(static_cast<std::size_t>(place.page));
        page.box.extend(page.items[static_cast<std::size_t>(place.item)].point.mean);
    }

    /// The item's id lies above all others'.
    void append(const Item& item) {
        if (pages_.empty() || pages_.back()->size == page_capacity)
            pages_.push_back(std::make_shared<Page>(owner_));
        Page& page = own(pages_.size() - 1);
        page.items[static_cast<std::size_t>(page.size++)] = item;
        page.box.extend(item.point.mean);
        ++size_;
    }

    /// Null when it is not there.
    const Item* find(LandmarkId id) const {
        Place place;
        return locate(id, place) ? &at(place) : nullptr;
    }
    bool locate(LandmarkId id, Place& place) const {
        auto next = std::upper_bound(
            pages_.begin(), pages_.end(), id,
            [](LandmarkId value, const auto& page) { return value < page->items.front().id; });
        if (next == pages_.begin()) return false;
        const Page& page = **--next;
        const auto end = page.items.begin() + page.size;
        const auto item = std::lower_bound(page.items.begin(), end, id,
                                           [](const Item& a, LandmarkId b) { return a.id < b; });
        if (item == end || item->id != id) return false;
        place = {static_cast<int>(next - pages_.begin()), static_cast<int>(item - page.items.begin())};
        return true;
    }

    /// visit(place, item) for all items at most `radius` [m] from `centre`, ascending by id.
    template <class Visit>
    void forEachNear(const Vector2& centre, double radius, const Visit& visit) const {
        for (int p = 0; p < pages(); ++p) {
            const Page& page = *pages_[static_cast<std::size_t>(p)];
            if (page.box.squaredExteriorDistance(centre) > radius * radius) continue;
            for (int i = 0; i < page.size; ++i) {
                const Item& item = page.items[static_cast<std::size_t>(i)];
                if ((item.point.mean - centre).squaredNorm() <= radius * radius) visit(Place{p, i}, item);
            }
        }
    }
    template <class Visit>
    void forEach(const Visit& visit) const {
        for (const auto& page : pages_)
            for (int i = 0; i < page->size; ++i) visit(page->items[static_cast<std::size_t>(i)]);
    }

    /// Of what was left behind nothing is missed: adds to `gone` what `isGone(item)` of the next page, so
    /// that a few calls look through all of them.
    template <class IsGone>
    void sweep(std::vector<Place>& gone, const IsGone& isGone) {
        if (++swept_ >= pages()) swept_ = 0;
        if (pages_.empty()) return;
        const Page& page = *pages_[static_cast<std::size_t>(swept_)];
        for (int i = 0; i < page.size; ++i)
            if (isGone(page.items[static_cast<std::size_t>(i)])) gone.push_back({swept_, i});
    }

    /// Takes out the items at `places`, in any order. Pages that get sparse are joined with their neighbours.
    void remove(std::vector<Place> places) {
        std::sort(places.begin(), places.end());
        places.erase(std::unique(places.begin(), places.end()), places.end());
        for (std::size_t k = places.size(); k-- > 0;) removeOne(places[k]);
    }

    /// Bytes of its pages, each counted in full by every particle that shares it; [0]: of those it owns
    /// alone.
    std::array<std::size_t, 2> bytes() const {
        std::size_t owned = 0;
        for (const auto& page : pages_) owned += page->owner == owner_ ? sizeof(Page) : 0;
        return {owned, pages_.size() * sizeof(Page)};
    }

  private:
    struct Page {
        explicit Page(Owner of) : owner(of) {}
        Owner owner;
        int size = 0;
        Eigen::AlignedBox2d box;
        std::array<Item, page_capacity> items;
    };

    const Page& page(Place place) const { return *pages_[static_cast<std::size_t>(place.page)]; }
    Page& own(std::size_t number) {
        auto& page = pages_[number];
        if (page->owner != owner_) {
            page = std::make_shared<Page>(*page);
            page->owner = owner_;
        }
        return *page;
    }

    void removeOne(Place place) {
        Page& page = own(static_cast<std::size_t>(place.page));
        const auto first = page.items.begin() + place.item;
        std::move(first + 1, page.items.begin() + page.size, first);
        --page.size;
        --size_;
        if (page.size == 0)
            pages_.erase(pages_.begin() + place.page);
        else if (page.size <= page_capacity / 4)
            joinWithNext(static_cast<std::size_t>(place.page));
    }

    void joinWithNext(std::size_t number) {
        if (number + 1 >= pages_.size() || pages_[number + 1]->size > page_capacity / 2) return;
        Page& page = own(number);
        const Page& next = *pages_[number + 1];
        std::copy_n(next.items.begin(), next.size, page.items.begin() + page.size);
        page.size += next.size;
        page.box.setEmpty();
        for (int i = 0; i < page.size; ++i)
            page.box.extend(page.items[static_cast<std::size_t>(i)].point.mean);
        pages_.erase(pages_.begin() + static_cast<std::ptrdiff_t>(number) + 1);
    }

    Owner owner_ = 0;
    int size_ = 0;
    int swept_ = 0;  ///< the page swept last
    std::vector<std::shared_ptr<Page>> pages_;
};

}  // namespace slamot

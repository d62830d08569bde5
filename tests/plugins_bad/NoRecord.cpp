// A shared library with the right file name that is no plugin.
extern "C" int somethingElse() {
    return 1;
}

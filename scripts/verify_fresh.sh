#!/bin/bash
# Makes a bare Debian 12 in a temporary folder, clones the committed tree into it, runs the README's two commands there,
# and proves that a second set-up does nothing and needs no network. Takes root and debootstrap.
#
#   FRESH_COMMANDS  commands to run instead, separated by semicolons   (make demo; make test)
#   FRESH_MIRROR    where debootstrap fetches Debian from              (http://deb.debian.org/debian)
#   FRESH_BIND      folders of this host to show read-only inside, e.g. a local package index that pip is configured for
#   FRESH_KEEP      set: leave the folder there
# This host's name resolution, certificates, and configuration of apt and pip (files and PIP_* variables) are copied.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
inside=/home/riser_soil
suite=bookworm
commands=${FRESH_COMMANDS:-make demo; make test}

main() {
    if [ "${1:-}" = --inside ]; then
        mount_and_run "$2"
        return
    fi
    [ "$(id -u)" -eq 0 ] || fail "needs root, for debootstrap and chroot"
    command -v debootstrap >/dev/null || fail "needs debootstrap: apt-get install debootstrap"
    git -C "$root" diff --quiet HEAD || echo "verify-fresh: uncommitted changes are not part of what is tested" >&2
    fresh=$(mktemp -d "${TMPDIR:-/tmp}/riser_soil-fresh.XXXXXX")
    trap clean_up EXIT
    timed "bare Debian ($suite, minbase)" make_bare_debian
    git clone --quiet "file://$root" "$fresh$inside"
    echo "verify-fresh: $(git -C "$fresh$inside" log -1 --format='commit %h, %s')"
    # All mounts live in a mount namespace of their own and vanish with it: clean_up can't reach through one of them.
    unshare --mount --pid --fork --kill-child "$0" --inside "$fresh"
    echo "verify-fresh: passed"
}

fail() {
    echo "verify-fresh: FAILED: $1" >&2
    exit 1
}

timed() { # title, command ...
    local title=$1 started=$SECONDS status=0
    shift
    echo "verify-fresh: $title ..."
    "$@" || status=$?
    [ $status -eq 0 ] || fail "$title (exit status $status, after $((SECONDS - started)) s)"
    echo "verify-fresh: $title: $((SECONDS - started)) s"
}

make_bare_debian() {
    debootstrap --variant=minbase --include=ca-certificates,git,make "$suite" "$fresh" \
        "${FRESH_MIRROR:-http://deb.debian.org/debian}" >"$fresh.log" 2>&1 || { tail -n 20 "$fresh.log"; return 1; }
    chmod 755 "$fresh" # mktemp leaves it to root alone
    copy_host_configuration
}

copy_host_configuration() {
    local file
    cp -L /etc/resolv.conf /etc/hosts "$fresh/etc/"
    if grep -q "VERSION_CODENAME=$suite" /etc/os-release; then
        rm -f "$fresh/etc/apt/sources.list"
        cp -a /etc/apt/. "$fresh/etc/apt/"
        cp -a /usr/share/keyrings/. "$fresh/usr/share/keyrings/"
    fi
    cp -a /usr/local/share/ca-certificates/. "$fresh/usr/local/share/ca-certificates/"
    chroot "$fresh" update-ca-certificates >/dev/null 2>&1
    for file in /etc/pip.conf /etc/xdg/pip/pip.conf "$HOME/.pip/pip.conf" "${XDG_CONFIG_HOME:-$HOME/.config}/pip/pip.conf"; do
        [ -f "$file" ] || continue
        case $file in
            "$HOME"/.pip/*) install -D -m 644 "$file" "$fresh/root/.pip/pip.conf" ;;
            /etc/*) install -D -m 644 "$file" "$fresh$file" ;;
            *) install -D -m 644 "$file" "$fresh/root/.config/pip/pip.conf" ;;
        esac
    done
}

mount_and_run() { # the new root; runs in its own mount and process namespace
    fresh=$1
    mount -t proc proc "$fresh/proc"
    mount --rbind /sys "$fresh/sys"
    mount --rbind /dev "$fresh/dev"
    local folder
    for folder in ${FRESH_BIND:-}; do
        mkdir -p "$fresh$folder"
        mount --bind -o ro "$folder" "$fresh$folder"
    done
    local command list
    IFS=';' read -ra list <<<"$commands"
    for command in "${list[@]}"; do
        command=${command#"${command%%[! ]*}"}
        timed "$command" in_fresh bash -c "cd $inside && $command"
    done
    timed "make setup again, without a network" second_setup
}

in_fresh() { # runs a command in the new root with nothing of this host's environment but what pip and proxies need
    local passed
    mapfile -t passed < <(env | grep -E '^(PIP_[A-Z_]+|https?_proxy|HTTPS?_PROXY|no_proxy|NO_PROXY|WORKERS)=')
    chroot "$fresh" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin "${passed[@]}" "$@"
}

second_setup() {
    local said
    said=$(in_fresh unshare --net bash -c "cd $inside && make setup 2>&1") || { echo "$said"; return 1; }
    echo "$said"
    [ "$said" = "set-up: nothing to do" ]
}

clean_up() {
    if [ -n "${FRESH_KEEP:-}" ]; then
        echo "verify-fresh: left in $fresh"
        return
    fi
    rm -rf --one-file-system "$fresh" "$fresh.log"
}

main "$@"

# Sums up what gcov says of the core's files: lines that tests reached, of lines.
/^File 'core\// { file = $2; core = 1; next }
/^File / { core = 0 }
core && /^Lines executed:/ {
    split($0, part, /[:% ]+/)
    share = part[3]; lines = part[5]
    printf "%-24s %6.2f %% of %d\n", file, share, lines
    reached += share / 100 * lines; all += lines; core = 0
}
END { printf "%-24s %6.2f %% of %d\n", "the core", 100 * reached / all, all }

# SPDX-License-Identifier: Apache-2.0
# What scripts/docs does to Markdown and headers before doxygen reads them: doxygen 1.9.4 does not know the anchors that headings have
# elsewhere. A link to a heading of another file becomes one to the file, one to a heading of the same file its text. And it
# takes @ for a command, and the # of a page that a comment cites for the name of a function.
s/\]\(([^)#]+\.md)#[^)]*\)/](\1)/g
s/\[([^]]*)\]\(#[^)]*\)/\1/g
s/@HZ/\\@HZ/g
s/\.md#/.md\\#/g

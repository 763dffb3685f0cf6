# SPDX-License-Identifier: Apache-2.0
# A module in a dozen lines of awk: hc camera A.jpg --encoding text | awk -f brightness.awk | hc cat
# The first line of a message is its header; then come `rows` lines with the numbers of the image.
rows == 0 {
  if ($7 % 10) {
    print "brightness.awk: the image is not text; write --encoding text for its sender" >"/dev/stderr"
    exit 1
  }
  src = $2; seq = $4; time = $6; rows = $10 > 0 ? $11 : 0; sum = count = 0
  next
}
{
  for (i = 1; i <= NF; ++i) sum += $i
  count += NF
  if (--rows == 0) printf "1 %d 0 %s 8 %s 120190 0 0 1 1\n%.17g\n", src, seq, time, sum / count
}

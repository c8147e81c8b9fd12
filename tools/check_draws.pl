#!/usr/bin/env perl
# SPDX-License-Identifier: Apache-2.0
# Random numbers must be drawn in an order that the language fixes: C++ leaves the order of a call's arguments and of the operands of
# + - * / to the compiler, so two draws there would give other numbers with another compiler. Ordered, and allowed: braces { a, b },
# declarators `x = …, y = …`, && || ?: << and both sides of an assignment. Usage: check_draws.pl FILE...
use strict;
use warnings;

my $status = 0;
for my $path (@ARGV) {
  open(my $file, '<', $path) or die "$path: $!\n";
  my $text = do { local $/; <$file> };
  next unless $text =~ /\b[Rr]ng/;
  $text =~ s{//[^\n]*|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)+'}{}g;
  my %drawing;        # lambdas of this file that draw from a captured generator
  my @open = frame(';', 0, 0, '');  # brackets around the current position; the file itself counts as a block
  my ($line, $call_draws, $control, $lambda) = (1, 0, 0, '');
  while ($text =~ /\G(?:(\n)|(&&|\|\||<<|>>|::|[=!<>]=|->)|\b(\w+)|(.))/gs) {
    my ($newline, $operator, $word, $char) = ($1, $2 // '', $3 // '', $4 // '');
    my $top = $open[-1];
    if ($newline) { $line++ }
    elsif ($operator) { $top->{draws} = 0 if $operator =~ /^(&&|\|\||<<|>>)$/ }
    elsif ($word) {
      my $from = pos($text) - length $word;
      my ($before, $after) = (substr($text, $from < 40 ? 0 : $from - 40, $from < 40 ? $from : 40), substr($text, pos $text, 40));
      $lambda = $word if $after =~ /^ = \[/;
      $top->{draws} = 0 if $word =~ /^(if|for|while|switch|return|else)$/;
      $control = $word =~ /^(if|for|while|switch)$/;
      $top->{local} = 1 if $word eq 'Rng' && $after =~ /^ \w+[;({=]/;
      $call_draws = 1 if $word =~ /^(normal|uniform|index|bits)$/ && $after =~ /^\(/ && $before =~ /\b(rng_?|draws?)\.$/;
      $call_draws = 1 if $drawing{$word} && $after =~ /^\(/ && $before !~ /[.:]$/;
      # f(a, rng): this call draws, after its arguments are known
      $top->{is_draw} = 1 if $word =~ /^(rng_?|draws)$/ && $after =~ /^\s*[,)]/ && $before =~ /[(,]\s*$/;
    }
    elsif ($char =~ /[(\[{]/) {
      push @open, frame($char, $call_draws, $control, $char eq '{' ? $lambda : '');
      ($call_draws, $control) = (0, 0);
      $lambda = '' if $char eq '{';
    }
    elsif ($char =~ /[)\]}]/ && @open > 1) {
      pop @open;
      my $block = $top->{block};
      $drawing{$top->{lambda}} = 1 if $block && $top->{lambda} && $top->{any} && !$top->{local};
      if ($block || $top->{control}) { $open[-1]{draws} = 0 if $open[-1]{bracket} ne '(' }
      elsif ($top->{any} || $top->{is_draw}) { count($path, $line, $open[-1]) }
    }
    elsif ($char eq ';') { $top->{block} = 1; $top->{draws} = 0; $lambda = '' }
    elsif ($char =~ /[?:=]/ || ($char eq ',' && $top->{bracket} ne '(')) { $top->{draws} = 0 }
  }
}
exit $status;

sub frame {
  my ($bracket, $is_draw, $control, $lambda) = @_;
  return {bracket => $bracket, is_draw => $is_draw, control => $control, lambda => $lambda, draws => 0, any => 0, block => 0, local => 0};
}

# One more draw in the present full expression of this bracket.
sub count {
  my ($path, $line, $frame) = @_;
  $frame->{any} = 1;
  return if ++$frame->{draws} != 2;
  print "$path:$line: several draws in one expression: the compiler chooses their order\n";
  $status = 1;
}
